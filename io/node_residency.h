// What selection may know of a node's data, kept by whoever owns the caches: drawable or not, and how far it
// still looks like its parent because it came late.
#pragma once

namespace ridgeline::io {

struct NodeResidency {
    float fade = 0.0f;  // 1: just arrived, drawn as the parent's surface; falls to 0
    bool resident = false;
};

}  // namespace ridgeline::io
