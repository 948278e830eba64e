// A whole store as one fuzz input: for each of its files a byte that names it, its length and its bytes.
#pragma once

#include <array>

namespace ridgeline::fuzz {

constexpr std::array kBundled = {"terrain.json", "nodes.bin",   "heights.tiles",
                                 "mesh.tiles",   "imagery.bin", "imagery.tiles"};

}  // namespace ridgeline::fuzz
