#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/random.h"
#include "library_fit/library_prior.h"
#include "transfer/transfer_world.h"
#include "twin/table_scene.h"
#include "workflows/twin/twin_record.h"

namespace simwright::bench {

// A table of library objects, as assets: the world that a twin stands for.
struct TrueTable {
  twin::TableScene scene;
  transfer::TransferWorld world;  // in the twin's frame; object k is object k of the scene
};

// Returns the world of a scene; its assets are written below `folder` with masses sampled by
// `seed`. Objects of which no asset can be made are left out of both.
TrueTable TrueTableOf(twin::TableScene scene, std::uint64_t seed,
                      const std::filesystem::path& folder);

// A twin and the object of the true table that each of its objects stands for; -1: none.
struct TwinOfTable {
  workflows::TwinRecord record;
  std::vector<int> truth;
};

// Writes a twin of the table that errs as its uncertainty states: that of twin::UncertaintyOf for
// outlines that agree with an IoU of `iou`, without an error of the scale. Kinds are right.
TwinOfTable PerturbedTable(const TrueTable& table, double iou, std::uint64_t seed, core::Rng* rng,
                           const std::filesystem::path& folder);

// Writes the twin that is rebuilt from the table's rendered picture with the true masks and the
// known camera.
TwinOfTable ReconstructedTable(const TrueTable& table, const twin::TableSceneSources& sources,
                               const library_fit::LibraryPrior& prior, std::uint64_t seed,
                               const std::filesystem::path& folder);

}  // namespace simwright::bench
