// Fills the horizon's panels from a frame's selection and the chunks that the pager holds.
//
// Render thread, after the frame's tiles were requested: what the scene then points to stays until the next
// frame is selected. Allocates nothing once the scene has seen its most nodes.
#pragma once

#include <vector>

#include "ridgeline/io/store.h"
#include "ridgeline/platform/camera.h"
#include "ridgeline/select/ground_source.h"
#include "ridgeline/select/selection.h"
#include "ridgeline/stage/horizon_scene.h"

namespace ridgeline::stage {

struct SurveySources {
    const io::Store& store;
    const select::Selection& selection;
    const select::GroundSource& ground;
};

// How the frame was seen.
struct SurveyView {
    platform::Camera camera;  // as lifted
    double exaggeration = 1.0;
    select::HorizonMode mode = select::HorizonMode::off;
};

class HorizonSurvey {
  public:
    void fill(const SurveySources& sources, const SurveyView& view, HorizonScene& scene);

  private:
    std::vector<select::NodeReport> reports_;
};

}  // namespace ridgeline::stage
