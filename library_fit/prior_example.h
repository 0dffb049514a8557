#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/random.h"
#include "library_fit/fit_kinds.h"
#include "library_fit/fit_view.h"

namespace simwright::library_fit {

// The sizes that the library prior's network and its training data share.
inline constexpr int kPriorSide = 64;   // pixels per side of the input crop
inline constexpr int kPriorDraws = 16;  // predicted choices of a generator; the later ones are not
inline constexpr double kPriorMargin = 1.15;  // of the crop around the object's bounding box

// A picture of an instance and what the network shall tell from it.
struct PriorExample {
  std::vector<std::uint8_t> picture;  // (kPriorSide^2 x 4) RGBA, sRGB, rows from the top
  int kind = 0;
  FitView view;
  std::array<float, 3> log_size{};  // of the size in m
  // In [0, 1): the generator's choices, then the opening; -1 where there is none.
  std::array<float, kPriorDraws + 1> choices{};
};

// Returns what the network shall tell of an instance that is seen from `view`, without a picture.
PriorExample LabelsOf(const Instance& instance, const FitView& view);

// Renders an instance of `kind` from a random view in random light. A part of the pictures has
// random colours instead of the library's, so that the network does not rely on them.
PriorExample MakePriorExample(int kind, std::uint64_t seed);

// Returns the kind of the n-th example of a training: articulated kinds are four times as frequent
// as rigid ones, since they have more choices.
int PriorExampleKind(core::Rng* rng);

}  // namespace simwright::library_fit
