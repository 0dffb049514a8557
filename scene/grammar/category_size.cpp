#include "scene/grammar/category_size.h"

#include <cmath>

#include "core/error.h"

namespace simwright::scene {

bool CategorySize::IsValid(std::string* error) const {
  const auto is_valid = [](double value) { return std::isfinite(value) && value >= 0.0; };
  if (!is_valid(half_size.x()) || !is_valid(half_size.y()) || !is_valid(height) ||
      !is_valid(rest_height)) {
    *error = "half sizes and heights must be finite and at least 0";
    return false;
  }
  if (half_size.minCoeff() == 0.0 || height == 0.0) {
    *error = "an asset must have a positive size";
    return false;
  }
  return true;
}

CategorySize RoundSize(double radius, double height, double rest_height) {
  return {Eigen::Vector2d::Constant(radius), height, rest_height};
}

CategorySize BoxSize(double half_x, double half_y, double height, double rest_height) {
  return {{half_x, half_y}, height, rest_height};
}

namespace {

CategorySizes MakeDefaults() {
  CategorySizes sizes;
  // Furniture. A table's height is that of its top.
  sizes["table_round"] = RoundSize(0.625, 0.785);          // (p)
  sizes["table_restaurant"] = RoundSize(0.625, 0.785);     // (p)
  sizes["table_breakfast"] = BoxSize(0.3575, 0.7, 0.75);   // (p) but for the height
  sizes["shelf_living_room"] = BoxSize(0.15, 0.3, 0.817);  // (p), to its uppermost board
  sizes["shelf_pantry"] = BoxSize(0.15, 0.3, 0.817);       // (p), to its uppermost board
  sizes["floor"] = BoxSize(5.0, 5.0, 0.05);
  sizes["chair"] = BoxSize(0.22, 0.24, 0.9);
  // Tableware.
  sizes["plate"] = RoundSize(0.1, 0.018, 0.018);
  sizes["bowl"] = RoundSize(0.0725, 0.065, 0.02);
  sizes["cup"] = RoundSize(0.05, 0.07);
  sizes["mug"] = RoundSize(0.05, 0.095);
  sizes["teapot"] = RoundSize(0.09, 0.13);
  sizes["serving_dish"] = RoundSize(0.13, 0.025);
  sizes["steamer"] = RoundSize(0.1, 0.091);  // (p)
  sizes["steamer_lid"] = RoundSize(0.1, 0.05);
  sizes["fork"] = BoxSize(0.095, 0.012, 0.015);
  sizes["knife"] = BoxSize(0.105, 0.01, 0.0075);
  sizes["spoon"] = BoxSize(0.09, 0.02, 0.013);
  sizes["teaspoon"] = BoxSize(0.07, 0.015, 0.013);
  sizes["utensil_crock"] = RoundSize(0.06, 0.15, 0.01);
  sizes["jug"] = RoundSize(0.06, 0.182);
  // Food.
  sizes["cereal_box"] = BoxSize(0.035, 0.095, 0.28);
  sizes["toast"] = BoxSize(0.052, 0.052, 0.016);
  sizes["apple"] = RoundSize(0.033, 0.07);
  sizes["apple_2"] = RoundSize(0.035, 0.075);
  sizes["apple_3"] = RoundSize(0.0375, 0.075);
  sizes["apple_4"] = RoundSize(0.0375, 0.075);
  sizes["pear"] = RoundSize(0.035, 0.095);
  sizes["pear_2"] = RoundSize(0.035, 0.09);
  sizes["pear_3"] = RoundSize(0.035, 0.09);
  sizes["avocado"] = RoundSize(0.035, 0.1);
  sizes["avocado_2"] = RoundSize(0.035, 0.1);
  sizes["avocado_3"] = RoundSize(0.035, 0.1);
  sizes["can"] = RoundSize(0.0334, 0.126);
  sizes["tea_bottle"] = RoundSize(0.0325, 0.208);
  // Objects on a living-room shelf.
  sizes["book"] = BoxSize(0.07, 0.025, 0.21);
  sizes["board_game_large"] = BoxSize(0.25, 0.1325, 0.06);
  sizes["board_game_small"] = BoxSize(0.1, 0.132, 0.06);
  sizes["console_game"] = BoxSize(0.07, 0.0625, 0.0125);
  sizes["stacking_ring"] = RoundSize(0.04, 0.1);
  sizes["toy_train"] = BoxSize(0.02, 0.045, 0.06);
  sizes["lamp"] = RoundSize(0.02, 0.1);
  sizes["speaker"] = BoxSize(0.0875, 0.035, 0.07);
  return sizes;
}

}  // namespace

const CategorySizes& DefaultCategorySizes() {
  static const CategorySizes sizes = MakeDefaults();
  return sizes;
}

const CategorySize& SizeOf(const CategorySizes& sizes, const std::string& category) {
  const auto entry = sizes.find(category);
  if (entry == sizes.end()) {
    throw core::Error("this category has no size", category, "add one, or start from the defaults");
  }
  std::string error;
  if (!entry->second.IsValid(&error)) throw core::Error(error, "size of category " + category);
  return entry->second;
}

}  // namespace simwright::scene
