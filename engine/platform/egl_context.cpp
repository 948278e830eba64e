// A context without a window, through EGL.
//
// Two ways lead there. Mesa's surfaceless platform needs nothing, not even a device node; but where a GPU's
// own driver does not know that platform, it ends in Mesa's CPU renderer beside an idle GPU. The device
// platform names the GPUs one by one and works without a display server. So: surfaceless first; if that draws
// on the CPU and nobody asked for the CPU, whichever device has a GPU behind it; else the surfaceless one
// after all.
#define MESA_EGL_NO_X11_HEADERS
#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ridgeline/base/log.h"
#include "ridgeline/base/thread_role.h"
#include "ridgeline/platform/context.h"
#include "ridgeline/platform/gl_version.h"

namespace ridgeline::platform {

namespace {

template <class Function>
Function egl_function(const char* name) {
    return reinterpret_cast<Function>(eglGetProcAddress(name));
}

bool lists(const char* extensions, std::string_view name) {
    const std::string_view all = extensions != nullptr ? extensions : "";
    for (std::size_t at = all.find(name); at != std::string_view::npos; at = all.find(name, at + 1)) {
        const bool begins = at == 0 || all[at - 1] == ' ';
        const bool ends = at + name.size() == all.size() || all[at + name.size()] == ' ';
        if (begins && ends) return true;
    }
    return false;
}

std::string egl_error() {
    const EGLint code = eglGetError();
    switch (code) {
        case EGL_SUCCESS:
            return "no reason given";
        case EGL_NOT_INITIALIZED:
            return "EGL_NOT_INITIALIZED";
        case EGL_BAD_ACCESS:
            return "EGL_BAD_ACCESS";
        case EGL_BAD_ALLOC:
            return "EGL_BAD_ALLOC";
        case EGL_BAD_ATTRIBUTE:
            return "EGL_BAD_ATTRIBUTE";
        case EGL_BAD_CONFIG:
            return "EGL_BAD_CONFIG";
        case EGL_BAD_CONTEXT:
            return "EGL_BAD_CONTEXT";
        case EGL_BAD_DISPLAY:
            return "EGL_BAD_DISPLAY";
        case EGL_BAD_MATCH:
            return "EGL_BAD_MATCH";
        case EGL_BAD_PARAMETER:
            return "EGL_BAD_PARAMETER";
        default:
            return "EGL error " + std::to_string(code);
    }
}

// A display that holds one context; the context dies with it. The display itself is shared by the whole
// process (EGL gives the same one for the same platform), so it is never terminated: another context may
// stand on it.
class HeadlessContext final : public Context {
  public:
    HeadlessContext(EGLDisplay display, EGLContext context, std::string platform)
        : display_(display), context_(context), platform_(std::move(platform)) {}
    ~HeadlessContext() override {
        if (eglGetCurrentContext() == context_)
            eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglDestroyContext(display_, context_);
    }

    void make_current() override {
        RIDGELINE_CHECK(eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_TRUE);
    }
    void present() override {}
    void poll(Input& input) override { begin_frame(input); }
    void set_mouse_mode(MouseMode) override {}
    glm::ivec2 size_px() const override { return size_px_; }
    GlLoader gl_loader() const override { return eglGetProcAddress; }
    std::string description() const override { return "headless (EGL " + platform_ + ")"; }
    GLFWwindow* glfw_window() const override { return nullptr; }

    void set_size_px(const glm::ivec2& size_px) { size_px_ = size_px; }
    const GlVersion& version() const { return version_; }
    void find_version() { version_ = read_gl_version(gl_loader()); }

  private:
    EGLDisplay display_;
    EGLContext context_;
    std::string platform_;
    glm::ivec2 size_px_{0};
    GlVersion version_;
};

using Attempt = Result<std::unique_ptr<HeadlessContext>>;

EGLContext create_context(EGLDisplay display, ContextDebug debug) {
    const std::array<EGLint, 9> attributes = {EGL_CONTEXT_MAJOR_VERSION,
                                              4,
                                              EGL_CONTEXT_MINOR_VERSION,
                                              5,
                                              EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                              EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                              EGL_CONTEXT_OPENGL_DEBUG,
                                              debug == ContextDebug::on ? EGL_TRUE : EGL_FALSE,
                                              EGL_NONE};
    return eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
}

// What the display has when it has no 4.5 core profile.
Error refusal(EGLDisplay display, const std::string& platform) {
    const std::string reason = egl_error();
    const EGLContext any = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, nullptr);
    if (any == EGL_NO_CONTEXT) return Error{"EGL " + platform + ": no OpenGL context: " + reason};
    HeadlessContext context(display, any, platform);
    context.make_current();
    const GlVersion found = read_gl_version(context.gl_loader());
    return found.enough() ? Error{"EGL " + platform + ": no core profile: " + reason} : too_old(found);
}

Attempt open_on(EGLDisplay display, const std::string& platform, ContextDebug debug) {
    if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) != EGL_TRUE)
        return Error{"EGL " + platform + ": " + egl_error()};
    const char* extensions = eglQueryString(display, EGL_EXTENSIONS);
    if (!lists(extensions, "EGL_KHR_surfaceless_context") || !lists(extensions, "EGL_KHR_no_config_context"))
        return Error{"EGL " + platform + ": the driver draws only to windows"};
    if (eglBindAPI(EGL_OPENGL_API) != EGL_TRUE)
        return Error{"EGL " + platform + ": the driver has no OpenGL"};
    const EGLContext created = create_context(display, debug);
    if (created == EGL_NO_CONTEXT) return refusal(display, platform);
    auto context = std::make_unique<HeadlessContext>(display, created, platform);
    context->make_current();
    context->find_version();
    log_line(LogLevel::debug, context->description() + ": OpenGL " + context->version().text + " on " +
                                  context->version().renderer);
    return context;
}

EGLDisplay platform_display(EGLenum platform, void* native) {
    const auto get = egl_function<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
    return get != nullptr ? get(platform, native, nullptr) : EGL_NO_DISPLAY;
}

Attempt open_surfaceless(ContextDebug debug) {
    if (!lists(eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS), "EGL_MESA_platform_surfaceless"))
        return Error{"EGL surfaceless: unknown to the driver"};
    return open_on(platform_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY), "surfaceless",
                   debug);
}

std::vector<EGLDeviceEXT> find_devices() {
    const auto query = egl_function<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
    EGLint count = 0;
    if (query == nullptr || query(0, nullptr, &count) != EGL_TRUE || count == 0) return {};
    std::vector<EGLDeviceEXT> devices(static_cast<std::size_t>(count));
    query(count, devices.data(), &count);
    devices.resize(static_cast<std::size_t>(count));
    return devices;
}

bool is_software_device(EGLDeviceEXT device) {
    const auto query = egl_function<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
    return query != nullptr && lists(query(device, EGL_EXTENSIONS), "EGL_MESA_device_software");
}

// The first device that is a GPU and gives a context that draws on it.
std::unique_ptr<HeadlessContext> open_gpu(ContextDebug debug) {
    int number = 0;
    for (EGLDeviceEXT device : find_devices()) {
        const std::string platform = "device " + std::to_string(number++);
        if (is_software_device(device)) continue;
        auto attempt = open_on(platform_display(EGL_PLATFORM_DEVICE_EXT, device), platform, debug);
        if (attempt && !attempt->get()->version().software()) return std::move(*attempt);
        if (!attempt) log_line(LogLevel::debug, attempt.error().message);
    }
    return nullptr;
}

bool cpu_is_asked_for() {
    for (const char* name : {"LIBGL_ALWAYS_SOFTWARE", "GALLIUM_DRIVER"}) {
        const char* value = std::getenv(name);
        if (value != nullptr && std::string_view(value) != "0" && std::string_view(value) != "false")
            return true;
    }
    return false;
}

Attempt open_best(ContextDebug debug) {
    Attempt surfaceless = open_surfaceless(debug);
    const bool on_cpu = !surfaceless || surfaceless->get()->version().software();
    if (!on_cpu || (surfaceless && cpu_is_asked_for())) return surfaceless;
    if (auto gpu = open_gpu(debug)) return gpu;
    if (surfaceless) surfaceless->get()->make_current();
    return surfaceless;
}

}  // namespace

Result<std::unique_ptr<Context>> open_headless(const HeadlessOptions& options) {
    RIDGELINE_ASSERT_ROLE(render);
    RIDGELINE_CHECK(options.size_px.x > 0 && options.size_px.y > 0);
    Attempt context = open_best(options.debug);
    if (!context) return Error{"no headless OpenGL: " + context.error().message};
    context->get()->set_size_px(options.size_px);
    return std::unique_ptr<Context>(std::move(*context));
}

}  // namespace ridgeline::platform
