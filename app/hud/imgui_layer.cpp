#include "imgui_layer.h"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>

namespace ridgeline::app {

namespace {

constexpr const char* kGlslVersion = "#version 450 core";

void set_style() {
    ImGui::StyleColorsDark();
    ImGuiStyle& style = ImGui::GetStyle();
    style.WindowRounding = 4.0f;
    style.WindowBorderSize = 0.0f;
    // The terrain stays visible behind it.
    style.Colors[ImGuiCol_WindowBg].w = 0.65f;
}

}  // namespace

Result<std::unique_ptr<ImguiLayer>> ImguiLayer::create(const platform::Context& context) {
    RIDGELINE_ASSERT_ROLE(render);
    RIDGELINE_CHECK(ImGui::GetCurrentContext() == nullptr);
    ImGui::CreateContext();
    // No file beside the program that remembers where windows stood.
    ImGui::GetIO().IniFilename = nullptr;
    set_style();
    GLFWwindow* window = context.glfw_window();
    std::unique_ptr<ImguiLayer> layer(
        new ImguiLayer(window != nullptr ? Backend::window : Backend::headless));
    if (window != nullptr) ImGui_ImplGlfw_InitForOpenGL(window, true);
    layer->draws_ = ImGui_ImplOpenGL3_Init(kGlslVersion);
    if (!layer->draws_) return Error{"HUD: ImGui could not be set up on this OpenGL driver"};
    return layer;
}

ImguiLayer::~ImguiLayer() {
    RIDGELINE_ASSERT_ROLE(render);
    if (draws_) ImGui_ImplOpenGL3_Shutdown();
    if (backend_ == Backend::window) ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

void ImguiLayer::begin_frame(const glm::ivec2& size_px, std::chrono::duration<double> dt) {
    RIDGELINE_ASSERT_ROLE(render);
    ImGui_ImplOpenGL3_NewFrame();
    if (backend_ == Backend::window) ImGui_ImplGlfw_NewFrame();
    if (backend_ == Backend::headless) {
        ImGuiIO& io = ImGui::GetIO();
        io.DisplaySize = ImVec2(static_cast<float>(size_px.x), static_cast<float>(size_px.y));
        // ImGui asserts that time advances.
        io.DeltaTime = std::max(static_cast<float>(dt.count()), 1e-6f);
    }
    ImGui::NewFrame();
}

void ImguiLayer::draw(const gl::Framebuffer& target) {
    RIDGELINE_ASSERT_ROLE(render);
    ImGui::Render();
    target.bind();
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

glm::dvec2 ImguiLayer::size() const {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    return {static_cast<double>(size.x), static_cast<double>(size.y)};
}

bool ImguiLayer::wants_mouse() const { return ImGui::GetIO().WantCaptureMouse; }
bool ImguiLayer::wants_keyboard() const { return ImGui::GetIO().WantCaptureKeyboard; }

}  // namespace ridgeline::app
