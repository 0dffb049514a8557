#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "asset_lift/radiance_field.h"

namespace simwright::asset_lift {

struct OccupancyOptions {
  double decay = 0.9;  // of a cell's density from an update to the next
  // A cell is empty when light crosses it with less than this lost, or less than the mean over all
  // cells where that is lower: the grid must not close over a field that is thin everywhere.
  double threshold = 0.01;
};

// Which of 64^3 cells of a field's cube are worth looking at. A cell keeps the largest density it
// was seen with, fading from update to update (Mueller et al. 2022, appendix C); cells may be ruled
// out for good. Positions are in half sides, as in FieldBatch. Reading is safe from several
// threads.
class OccupancyGrid {
 public:
  static constexpr int kSide = 64;
  static constexpr double kCell = 2.0 / kSide;  // half sides

  OccupancyGrid();  // everything is worth looking at

  // Rules out the cells where `allowed` (64^3, x fastest) is 0. Throws core::Error for another
  // size.
  void Restrict(const std::vector<std::uint8_t>& allowed);

  // Looks at the field in one random point of each cell that is not ruled out, drawn from `seed`.
  template <typename Real>
  void Update(const BasicRadianceField<Real>& field, const OccupancyOptions& options,
              std::uint64_t seed);

  bool Occupied(double x, double y, double z) const {
    const int i = CellOf(x), j = CellOf(y), k = CellOf(z);
    return (occupied_[j + kSide * k] >> i) & 1;
  }
  // Whether a cell is not ruled out.
  bool Allowed(double x, double y, double z) const {
    const int i = CellOf(x), j = CellOf(y), k = CellOf(z);
    return (allowed_[j + kSide * k] >> i) & 1;
  }

  // The part of the ray origin + t direction, t in [*near, *far], between the first and the last
  // occupied cell, found in steps of half a cell at most and widened by one. False where there is
  // none, or the ray misses the cube.
  bool Clip(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double* near,
            double* far) const;

  // Share of the cells that are occupied.
  double OccupiedShare() const;

 private:
  static int CellOf(double x) {
    const int i = static_cast<int>((x + 1.0) * (kSide / 2));
    return i < 0 ? 0 : i >= kSide ? kSide - 1 : i;
  }

  // A bit a cell, x along the word: the whole grid fits the first-level cache.
  std::vector<std::uint64_t> allowed_, occupied_;
  std::vector<float> density_;  // per half side, x fastest; empty before the first update
};

}  // namespace simwright::asset_lift
