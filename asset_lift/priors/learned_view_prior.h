#pragma once

#include <filesystem>
#include <memory>

#include "asset_lift/priors/shape_prior.h"

namespace simwright::asset_lift {

class ViewPrior;

// Loads our own view prior (see view_network.h); `shape` predicts the reference's shape. Throws
// core::Error where the weights are missing, damaged or of another kind.
std::shared_ptr<ViewPrior> LoadLearnedViewPrior(const std::filesystem::path& weights,
                                                std::shared_ptr<const ShapePrior> shape);

}  // namespace simwright::asset_lift
