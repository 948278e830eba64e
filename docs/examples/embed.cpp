// The terrain in a window of one's own: GLFW and the camera are this program's, the ground is Ridgeline's.
//
//   embed DIR.terrain [FRAMES]
//
// Flies round the middle of the terrain until the window is closed, or for so many frames.
// Ridgeline brings OpenGL's names.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "ridgeline/base/thread_role.h"
#include "ridgeline/gl/capabilities.h"
#include "ridgeline/gl/framebuffer.h"
#include "ridgeline/io/store.h"
#include "ridgeline/jobs/job_system.h"
#include "ridgeline/stage/terrain_stage.h"

namespace {

using ridgeline::Angle;
using ridgeline::Error;
using ridgeline::Result;
namespace io = ridgeline::io;
namespace platform = ridgeline::platform;
namespace stage = ridgeline::stage;

struct Window {
    Window() {
        if (glfwInit() != GLFW_TRUE) return;
        glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
        glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
        glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
        handle = glfwCreateWindow(800, 600, "A program of one's own", nullptr, nullptr);
        if (handle != nullptr) glfwMakeContextCurrent(handle);
    }
    ~Window() { glfwTerminate(); }

    glm::ivec2 size_px() const {
        glm::ivec2 size{0};
        glfwGetFramebufferSize(handle, &size.x, &size.y);
        return glm::max(size, glm::ivec2(1));
    }

    GLFWwindow* handle = nullptr;
};

// Round the middle, over everything, looking inwards and down. The stage lifts an eye that is too low.
platform::Pose pose_at(const io::TerrainInfo& info, double time_s) {
    const glm::dvec3 middle_m(0.5 * (info.min_east_m() + info.max_east_m()),
                              0.5 * (info.min_north_m() + info.max_north_m()), info.min_height_m);
    const double radius_m =
        0.4 * std::min(info.max_east_m() - info.min_east_m(), info.max_north_m() - info.min_north_m());
    const double around = 0.1 * time_s;
    const glm::dvec3 eye_m = middle_m + glm::dvec3(radius_m * std::cos(around), radius_m * std::sin(around),
                                                   info.max_height_m - info.min_height_m + 0.2 * radius_m);
    return platform::looking_along(eye_m, middle_m - eye_m);
}

// One frame into the window: selection, paging and drawing are the stage's.
stage::StageReport show_frame(const Window& window, stage::TerrainStage& terrain, const io::TerrainInfo& info,
                              std::uint64_t number) {
    stage::StageMoment moment;
    moment.number = number;
    moment.now = ridgeline::pager::Seconds(glfwGetTime());
    moment.camera.pose = pose_at(info, glfwGetTime());
    moment.camera.lens.horizontal_fov = Angle::from_degrees(75.0);
    moment.camera.lens.size_px = terrain.target().size_px();
    const auto report = terrain.show(moment);
    ridgeline::gl::blit_to_window(terrain.target(), window.size_px());
    glfwSwapBuffers(window.handle);
    glfwPollEvents();
    return report;
}

Result<void> fly(const Window& window, const io::Store& store, long frames) {
    RIDGELINE_TRY(ridgeline::gl::load(glfwGetProcAddress));
    ridgeline::jobs::JobSystem jobs;
    stage::StageOptions options;
    options.frame.size_px = window.size_px();
    auto terrain = stage::TerrainStage::create(store, jobs, options);
    if (!terrain) return terrain.error();
    std::uint64_t triangles = 0;
    long frame = 0;
    for (; glfwWindowShouldClose(window.handle) == GLFW_FALSE && (frames == 0 || frame < frames); ++frame) {
        if (window.size_px() != (*terrain)->target().size_px())
            RIDGELINE_TRY((*terrain)->resize(window.size_px()));
        triangles = show_frame(window, **terrain, store.info(), static_cast<std::uint64_t>(frame))
                        .selection.triangles;
    }
    std::printf("%ld frames; %llu triangles in the last\n", frame,
                static_cast<unsigned long long>(triangles));
    return {};
}

Result<void> run(const char* directory, long frames) {
    const auto store = io::Store::open(directory);
    if (!store) return store.error();
    const Window window;
    if (window.handle == nullptr) return Error{"no window with OpenGL 4.5: is there a display?"};
    return fly(window, *store, frames);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2 || argc > 3) return std::fprintf(stderr, "usage: embed DIR.terrain [FRAMES]\n"), 2;
    // The thread that owns the context; debug builds hold Ridgeline's calls to it.
    ridgeline::set_thread_role(ridgeline::ThreadRole::render, "render");
    if (const auto ran = run(argv[1], argc > 2 ? std::atol(argv[2]) : 0); !ran)
        return std::fprintf(stderr, "embed: error: %s\n", ran.error().message.c_str()), 1;
    return 0;
}
