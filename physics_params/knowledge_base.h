#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace simwright::physics_params {

struct Interval {
  double min = 0.0;
  double max = 0.0;
  bool Contains(double value) const { return value >= min && value <= max; }
};

// How matter fills the outline of a kind of thing.
enum class Fill {
  kSolid,   // full of its material
  kHollow,  // a closed wall
  kOpen,    // a wall, open above
  kFrame    // parts with air between them
};

// The kind's usual outline: what a lifted or imported shape may be expected to look like.
enum class Shape { kRound, kRevolved, kBox, kFlat, kLong, kFree };

struct Material {
  std::string name;
  Interval density;      // kg/m^3
  Interval friction;     // Coulomb coefficient against wood or plastic
  Interval restitution;  // against a hard floor
  std::string source;
};

// One kind of household thing. `length` >= `width` are its sides on the ground, `height` as it
// stands.
struct Category {
  std::string name;
  Interval length, width, height;      // m
  Interval mass;                       // kg
  std::vector<std::string> materials;  // likeliest first; each is in the base
  Fill fill = Fill::kSolid;
  Shape shape = Shape::kFree;
  std::string source;  // a sentence
};

// What is known of household things. Constant after construction; safe from several threads.
class KnowledgeBase {
 public:
  // Parses the three tables (formats: the comments at their heads). Throws core::Error, naming
  // table and line, on a malformed row, an unknown material or source, or min > max.
  KnowledgeBase(std::string_view categories, std::string_view materials, std::string_view sources);

  // The base that is shipped with the program.
  static const KnowledgeBase& Shipped();

  const std::vector<Category>& categories() const { return categories_; }
  const std::vector<Material>& materials() const { return materials_; }

  // Exact match of the normalised name (see NormaliseName), or null.
  const Category* FindCategory(std::string_view name) const;
  const Material* FindMaterial(std::string_view name) const;

 private:
  std::vector<Category> categories_;
  std::vector<Material> materials_;
};

// Lower case, with '_', '-' and runs of blanks as one blank, and blanks at the ends removed.
std::string NormaliseName(std::string_view name);

const char* FillName(Fill fill);
const char* ShapeName(Shape shape);

}  // namespace simwright::physics_params
