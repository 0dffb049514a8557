#pragma once

#include <vector>

#include "core/random.h"
#include "scene/dataset/scene_dataset.h"

namespace simwright::scene {

struct StreamOptions {
  // Scenes first .. first + count - 1 of the dataset; count -1: to the end.
  int first = 0, count = -1;
  // Scenes held in memory, among which the next is drawn: 4096 of dimsum are 12 MB.
  int buffer = 4096;
  int block = 64;  // scenes read at once, in the order of the dataset; blocks come in random order

  bool IsValid(std::string* error) const;
};

// Scenes of a dataset over and over in random order, read block by block into a buffer of fixed
// size from which each is drawn and replaced: every scene comes once a round over the dataset, give
// or take the buffer. With a dataset that fits in the buffer, nothing is read twice. The dataset
// must outlive it; one thread at a time.
class SceneStream {
 public:
  // Throws core::Error for options that are not valid or name no scene.
  SceneStream(const SceneDataset& dataset, const StreamOptions& options, std::uint64_t seed);

  // Writes `count` scenes' tokens (count x entries x TokenWidth). Throws core::Error where the
  // dataset is damaged.
  void Next(int count, float* tokens);

 private:
  void ReadBlock();
  size_t SceneSize() const;
  int BlockCount() const;

  const SceneDataset& dataset_;
  StreamOptions options_;
  int last_ = 0;  // one behind
  core::Rng rng_;
  std::vector<int> order_;      // of blocks, this round
  size_t next_block_ = 0;       // in order_
  std::vector<float> pending_;  // of the block read last, not yet in the buffer
  size_t next_pending_ = 0;     // scene
  std::vector<float> buffer_;
  bool whole_ = false;  // the buffer holds all scenes there are
  std::vector<int> whole_order_;
  size_t next_whole_ = 0;
};

}  // namespace simwright::scene
