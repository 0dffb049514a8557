#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace simwright::physics_params {

struct Interval {
  double min = 0.0;
  double max = 0.0;
  bool Contains(double value) const { return value >= min && value <= max; }
};

// The arrangement of material within an object's outline.
enum class Fill {
  kSolid,   // solid material
  kHollow,  // a closed wall
  kOpen,    // a wall, open above
  kFrame    // parts with gaps between them
};

// The category's usual shape, expected of a reconstructed or imported mesh.
enum class Shape { kRound, kRevolved, kBox, kFlat, kLong, kFree };

struct Material {
  std::string name;
  Interval density;      // kg/m^3
  Interval friction;     // Coulomb coefficient against wood or plastic
  Interval restitution;  // against a hard floor
  std::string source;
};

enum class SizeClass { kSmall, kMedium, kLarge };

// Another row that the bare name of a row also covers, such as a plastic mug for a mug.
struct Variant {
  std::string category;  // the row's name
  double weight = 0.0;   // share of such objects under the bare name, in (0, 1)
  std::optional<SizeClass> size_class;
  bool from_objects = false;  // written for measured objects, which then cannot judge it
};

// A category of household objects. `length` >= `width` are its horizontal sides, `height` is
// vertical, in its upright pose.
struct Category {
  std::string name;
  Interval length, width, height;      // m
  Interval mass;                       // kg
  std::vector<std::string> materials;  // most likely first; each is in the base
  Fill fill = Fill::kSolid;
  Shape shape = Shape::kFree;
  std::string source;  // a sentence
  // The row itself keeps the rest of the weight.
  std::vector<Variant> variants = {};
};

// The knowledge base of household objects. Immutable after construction; thread-safe.
class KnowledgeBase {
 public:
  // Parses the tables (formats: the comments at their tops). Throws core::Error, naming table and
  // line, for a malformed row, an unknown material, source or row, min > max, or variants whose
  // weights reach 1.
  KnowledgeBase(std::string_view categories, std::string_view materials, std::string_view sources,
                std::string_view variants = "");

  // Returns the base that ships with the program.
  static const KnowledgeBase& Shipped();

  const std::vector<Category>& categories() const { return categories_; }
  const std::vector<Material>& materials() const { return materials_; }

  // Returns the exact match of the normalised name (see NormaliseName), or null.
  const Category* FindCategory(std::string_view name) const;
  const Material* FindMaterial(std::string_view name) const;

 private:
  void ReadVariants(std::string_view variants);

  std::vector<Category> categories_;
  std::vector<Material> materials_;
};

// Converts to lower case, with '_', '-' and runs of blanks as one blank, and strips blanks at the
// ends.
std::string NormaliseName(std::string_view name);

const char* FillName(Fill fill);
const char* ShapeName(Shape shape);
const char* SizeClassName(SizeClass size_class);

// Returns the class of a name: small, medium or large. Throws core::Error for another one.
SizeClass SizeClassOf(std::string_view name);

}  // namespace simwright::physics_params
