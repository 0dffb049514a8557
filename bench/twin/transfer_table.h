#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/random.h"
#include "library_fit/library_prior.h"
#include "transfer/transfer_world.h"
#include "twin/table_scene.h"
#include "workflows/twin/twin_record.h"

namespace simwright::bench {

// A table and its twin.
struct TransferTable {
  workflows::TwinRecord twin;     // its assets lie in a folder
  std::vector<bool> is_real;      // by object of the twin: it stands for an object of the table
  transfer::TransferWorld table;  // the true objects in the twin's frame, named as in the twin
};

// Writes a twin of the scene below `folder` that errs as its uncertainty states: that of
// twin::UncertaintyOf for outlines that agree with an IoU of `iou`, without an error of the scale.
// Kinds are right. True masses and frictions differ from the twin's by factors of up to 2 and 1.3.
// Objects of which no asset can be made are left out.
TransferTable PerturbedTable(const twin::TableScene& scene, double iou, std::uint64_t seed,
                             core::Rng* rng, const std::filesystem::path& folder);

// Writes the twin that is rebuilt from the scene's rendered picture with the true masks and the
// known camera; the true assets lie below `true_folder`.
TransferTable ReconstructedTable(const twin::TableScene& scene,
                                 const twin::TableSceneSources& sources,
                                 const library_fit::LibraryPrior& prior, std::uint64_t seed,
                                 const std::filesystem::path& folder,
                                 const std::filesystem::path& true_folder);

}  // namespace simwright::bench
