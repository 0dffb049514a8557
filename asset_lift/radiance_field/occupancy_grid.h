#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "asset_lift/radiance_field/field_fit_options.h"
#include "asset_lift/radiance_field/radiance_field.h"

namespace simwright::asset_lift {

// The occupancy of the 64^3 cells of a field's cube. A cell keeps the maximum density at which it
// was sampled, decaying with every update (Mueller et al. 2022, appendix C); cells may be excluded
// permanently. Positions are in half sides, as in FieldBatch. Reading is thread-safe.
class OccupancyGrid {
 public:
  static constexpr int kSide = 64;
  static constexpr double kCell = 2.0 / kSide;  // half sides

  OccupancyGrid();  // all cells are occupied

  // Excludes the cells where `allowed` (64^3, x fastest) is 0. Throws core::Error for another size.
  void Restrict(const std::vector<std::uint8_t>& allowed);

  // Evaluates the field at one random point, sampled from `seed`, of each cell that is not
  // excluded.
  template <typename Real>
  void Update(const BasicRadianceField<Real>& field, const OccupancyOptions& options,
              std::uint64_t seed);

  bool Occupied(double x, double y, double z) const {
    const int i = CellOf(x), j = CellOf(y), k = CellOf(z);
    return (occupied_[j + kSide * k] >> i) & 1;
  }
  // Returns true if the cell is not excluded.
  bool Allowed(double x, double y, double z) const {
    const int i = CellOf(x), j = CellOf(y), k = CellOf(z);
    return (allowed_[j + kSide * k] >> i) & 1;
  }

  // Clips the ray origin + t direction, t in [*near, *far], to the range between the first and the
  // last occupied cell, marched in steps of at most half a cell and widened by one step. Returns
  // false if there is no such cell or the ray misses the cube.
  bool Clip(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double* near,
            double* far) const;

  // Returns the share of the cells that are occupied.
  double OccupiedShare() const;

 private:
  static int CellOf(double x) {
    const int i = static_cast<int>((x + 1.0) * (kSide / 2));
    return i < 0 ? 0 : i >= kSide ? kSide - 1 : i;
  }

  // One bit per cell, x along the word: the whole grid fits the first-level cache.
  std::vector<std::uint64_t> allowed_, occupied_;
  std::vector<float> density_;  // per half side, x fastest; empty before the first update
};

}  // namespace simwright::asset_lift
