#pragma once

#include <vector>

#include "core/random.h"
#include "scene/dataset/scene_dataset.h"

namespace simwright::scene {

struct StreamOptions {
  // Scenes first .. first + count - 1 of the dataset; count -1: to the end.
  int first = 0, count = -1;
  // The number of scenes in the shuffle buffer; 4096 scenes of dimsum take 12 MB.
  int buffer = 4096;
  int scenes_per_block = 64;  // scenes per read, contiguous in the dataset; the blocks are shuffled

  bool IsValid(std::string* error) const;
};

// An endless stream of the scenes of a dataset in random order. Blocks are read into a shuffle
// buffer of fixed size, from which scenes are sampled and replaced: every scene comes once per
// epoch, up to the size of the buffer. A dataset that fits into the buffer is read once only. The
// dataset must outlive the stream; not thread-safe.
class SceneStream {
 public:
  // Throws core::Error for invalid options or an empty range of scenes.
  SceneStream(const SceneDataset& dataset, const StreamOptions& options, std::uint64_t seed);

  // Writes the tokens of `count` scenes (count x entries x TokenWidth). Throws core::Error if the
  // dataset is damaged.
  void Next(int count, float* tokens);

 private:
  void ReadBlock();
  size_t SceneSize() const;
  int BlockCount() const;

  const SceneDataset& dataset_;
  StreamOptions options_;
  int last_ = 0;  // one past the last scene
  core::Rng rng_;
  std::vector<int> order_;      // of blocks, in this epoch
  size_t next_block_ = 0;       // index into order_
  std::vector<float> pending_;  // tokens of the last block, not yet in the buffer
  size_t next_pending_ = 0;     // index of a scene
  std::vector<float> buffer_;
  bool whole_ = false;  // the buffer holds all scenes
  std::vector<int> whole_order_;
  size_t next_whole_ = 0;
};

}  // namespace simwright::scene
