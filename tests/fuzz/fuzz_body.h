// What a fuzz target is: a decoder family's body, which takes one input whatever it holds.
//
// Two drivers call it: libfuzzer.cpp under clang's fuzzer, and replay.cpp, which feeds it the corpus in every
// build. A body stops the program where a decoder broke a promise (round trips, bounds), and else says whether
// the input was sound. One thread at a time.
#pragma once

#include <cstdint>
#include <span>

namespace ridgeline::fuzz {

// Sound: decoded without an Error.
enum class Verdict { sound, refused };

Verdict try_input(std::span<const std::uint8_t> bytes);

}  // namespace ridgeline::fuzz
