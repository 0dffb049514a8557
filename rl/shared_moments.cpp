#include "rl/shared_moments.h"

#include <cstring>
#include <string>
#include <vector>

#include "core/error.h"

namespace simwright::rl {
namespace {

// Converts moments of C columns to 1 + 2 C doubles and back.
std::string BytesOf(const RunningMoments& moments) {
  std::vector<double> numbers = {moments.count};
  numbers.insert(numbers.end(), moments.mean.begin(), moments.mean.end());
  numbers.insert(numbers.end(), moments.squares.begin(), moments.squares.end());
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(double)};
}

RunningMoments MomentsOf(const std::string& bytes, Eigen::Index columns) {
  std::vector<double> numbers(1 + 2 * static_cast<std::size_t>(columns));
  if (bytes.size() != numbers.size() * sizeof(double)) {
    throw core::Error("the ranks have observations of different sizes", "training");
  }
  std::memcpy(numbers.data(), bytes.data(), bytes.size());
  RunningMoments moments(static_cast<int>(columns));
  moments.count = numbers[0];
  std::copy_n(numbers.begin() + 1, columns, moments.mean.begin());
  std::copy_n(numbers.begin() + 1 + columns, columns, moments.squares.begin());
  return moments;
}

}  // namespace

RunningMoments Merged(const RunningMoments& first, const RunningMoments& second) {
  if (first.count == 0.0) return second;
  if (second.count == 0.0) return first;
  RunningMoments both = first;
  both.count = first.count + second.count;
  const Eigen::ArrayXd apart = second.mean - first.mean;
  both.mean += apart * (second.count / both.count);
  both.squares += second.squares + apart.square() * (first.count * second.count / both.count);
  return both;
}

RunningMoments Without(const RunningMoments& all, const RunningMoments& part) {
  if (part.count == 0.0) return all;
  RunningMoments rest(static_cast<int>(all.mean.size()));
  rest.count = all.count - part.count;
  if (rest.count <= 0.0) return RunningMoments(static_cast<int>(all.mean.size()));
  rest.mean = part.mean + (all.mean - part.mean) * (all.count / rest.count);
  const Eigen::ArrayXd apart = rest.mean - part.mean;
  const Eigen::ArrayXd between = apart.square() * (part.count * rest.count / all.count);
  rest.squares = (all.squares - part.squares - between).max(0.0);
  return rest;
}

RunningMoments MergedOverRanks(const RunningMoments& before, const RunningMoments& now,
                               Communicator* ranks) {
  if (ranks->size() == 1) return now;
  RunningMoments merged = before;
  for (const std::string& bytes : ranks->AllGather(BytesOf(Without(now, before)))) {
    merged = Merged(merged, MomentsOf(bytes, now.mean.size()));
  }
  return merged;
}

}  // namespace simwright::rl
