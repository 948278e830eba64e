#include "ridgeline/platform/input.h"

namespace ridgeline::platform {

void begin_frame(Input& input) {
    input.keys_pressed.reset();
    input.buttons_pressed.reset();
    input.mouse_motion_px = {};
    input.wheel_steps = 0.0;
    input.text.clear();
    input.resized_to_px.reset();
}

}  // namespace ridgeline::platform
