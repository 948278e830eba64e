// What is being measured: the rays that were clicked, and what the surveyor found for them. One click is a
// point, two are a line, the third starts anew. Render thread; store and names outlive it.
#pragma once

#include <array>
#include <optional>

#include "ridgeline/app/hud/measure_panel.h"
#include "ridgeline/app/walk/measure.h"
#include "ridgeline/app/walk/place_names.h"
#include "ridgeline/app/walk/surveyor.h"

namespace ridgeline::app {

class Measuring {
  public:
    Measuring(const io::Store& store, const PlaceNames& places) : places_(places), surveyor_(store) {}

    void add(const GroundRay& ray);
    void clear();
    // Neither a point nor a question for one.
    bool empty() const { return question_.rays == 0; }
    // Takes in what the surveyor found. What there is to tell the user, or null.
    const char* listen();
    // Null while there is nothing to show. Stays until the next call of any of these.
    const MeasureScene* scene(const platform::Camera& camera, const VerticalScale& scale);

  private:
    const PlaceNames& places_;
    SurveyQuestion question_{.rays = 0};
    std::optional<SurveyAnswer> answer_;  // to the question as it is, or with one ray less
    MeasureScene scene_;
    Surveyor surveyor_;
};

}  // namespace ridgeline::app
