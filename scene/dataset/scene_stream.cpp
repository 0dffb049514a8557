#include "scene/dataset/scene_stream.h"

#include <algorithm>
#include <numeric>

#include "core/error.h"
#include "core/shuffle.h"

namespace simwright::scene {

bool StreamOptions::IsValid(std::string* error) const {
  const auto fails = [&](const char* what) {
    *error = what;
    return false;
  };
  if (first < 0) return fails("first must be at least 0");
  if (count < -1 || count == 0) return fails("count must be at least 1, or -1 for all");
  if (buffer < 1) return fails("buffer must be at least 1 scene");
  if (scenes_per_block < 1) return fails("scenes_per_block must be at least 1 scene");
  return true;
}

SceneStream::SceneStream(const SceneDataset& dataset, const StreamOptions& options,
                         std::uint64_t seed)
    : dataset_(dataset), options_(options), rng_(core::StreamRng(seed, 0)) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error("stream of scenes: " + error);
  const int all = dataset.SceneCount();
  last_ = options.count < 0 ? all : options.first + options.count;
  if (options.first >= all || last_ > all) {
    throw core::Error("the dataset has " + std::to_string(all) + " scenes; more are requested");
  }
  if (last_ - options_.first <= options_.buffer) {
    whole_ = true;
    buffer_ = dataset.Read(options_.first, last_ - options_.first);
    whole_order_.resize(static_cast<size_t>(last_ - options_.first));
    std::iota(whole_order_.begin(), whole_order_.end(), 0);
    next_whole_ = whole_order_.size();
    return;
  }
  order_.resize(static_cast<size_t>(BlockCount()));
  std::iota(order_.begin(), order_.end(), 0);
  next_block_ = order_.size();
  const size_t wanted = static_cast<size_t>(options_.buffer) * SceneSize();
  while (buffer_.size() < wanted) {
    ReadBlock();
    const size_t some = std::min(pending_.size(), wanted - buffer_.size());
    buffer_.insert(buffer_.end(), pending_.begin(),
                   pending_.begin() + static_cast<std::ptrdiff_t>(some));
    next_pending_ = some / SceneSize();
  }
}

size_t SceneStream::SceneSize() const {
  return static_cast<size_t>(dataset_.vocabulary().entries) *
         static_cast<size_t>(dataset_.vocabulary().TokenWidth());
}

int SceneStream::BlockCount() const {
  return (last_ - options_.first + options_.scenes_per_block - 1) / options_.scenes_per_block;
}

void SceneStream::ReadBlock() {
  if (next_block_ == order_.size()) {
    core::Shuffle(&order_, rng_);
    next_block_ = 0;
  }
  const int from = options_.first + order_[next_block_++] * options_.scenes_per_block;
  pending_ = dataset_.Read(from, std::min(options_.scenes_per_block, last_ - from));
  next_pending_ = 0;
}

void SceneStream::Next(int count, float* tokens) {
  const size_t size = SceneSize();
  for (int i = 0; i < count; ++i, tokens += size) {
    if (whole_) {
      if (next_whole_ == whole_order_.size()) {
        core::Shuffle(&whole_order_, rng_);
        next_whole_ = 0;
      }
      const float* const scene = &buffer_[static_cast<size_t>(whole_order_[next_whole_++]) * size];
      std::copy(scene, scene + size, tokens);
      continue;
    }
    if (next_pending_ * size == pending_.size()) ReadBlock();
    float* const scene =
        &buffer_[static_cast<size_t>(core::UniformIndex(rng_, options_.buffer)) * size];
    std::copy(scene, scene + size, tokens);
    const float* const fresh = &pending_[next_pending_++ * size];
    std::copy(fresh, fresh + size, scene);
  }
}

}  // namespace simwright::scene
