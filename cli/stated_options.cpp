#include "cli/stated_options.h"

#include "cli/number_validators.h"

namespace simwright::cli {

void AddVariantOptions(CLI::App* command, physics_params::VariantChoice* variant) {
  command
      ->add_option("--material", variant->material,
                   "The material, e.g. plastic: chooses a variant of the category")
      ->default_str("from the category");
  command
      ->add_option_function<std::string>(
          "--size-class",
          [variant](const std::string& name) {
            variant->size_class = physics_params::SizeClassOf(name);
          },
          "A small, medium or large object of its category")
      ->check(CLI::IsMember({"small", "medium", "large"}))
      ->default_str("any");
}

void AddStatedOptions(CLI::App* command, asset_build::StatedSize* size,
                      physics_params::StatedPhysics* stated) {
  command
      ->add_option(
          "--size", *size,
          "The object's true size, m: the longest side, or length,width,height when upright")
      ->delimiter(',')
      ->expected(1, 3)
      ->allow_extra_args(false)
      ->default_str("from the category");
  command->add_option("--mass", stated->mass, "The object's true mass, kg")
      ->check(Positive())
      ->default_str("from the category");
  command
      ->add_option(
          "--density", stated->density,
          "The material's density, kg/m3: fills the shape, or with --mass gives a hollow one")
      ->check(Positive())
      ->default_str("from the material");
  AddVariantOptions(command, &stated->variant);
  command->add_option("--friction", stated->friction, "Coulomb coefficient")
      ->check(CLI::Range(0.0, 10.0))
      ->default_str("from the material");
}

void AddPartOptions(CLI::App* command, asset_build::PartBudget* budget) {
  command
      ->add_option("--max-parts", budget->max_parts,
                   "The maximum number of collision parts, of each link of an articulated asset")
      ->check(CLI::Range(1, asset_build::kMostParts))
      ->default_str("as many as the precision takes");
  command
      ->add_option("--max-vertices", budget->max_vertices,
                   "The maximum number of vertices of a collision part")
      ->check(CLI::Range(asset_build::kLeastVertices, asset_build::kMostVertices))
      ->default_str("64");
  command
      ->add_option("--max-faces", budget->max_faces,
                   "The maximum number of triangles of a collision part")
      ->check(CLI::Range(asset_build::kLeastFaces, 2 * asset_build::kMostVertices - 4))
      ->default_str("as many as the vertices allow");
  command
      ->add_option("--part-tolerance", budget->tolerance,
                   "The largest distance by which a collision part may deviate from the solid, m")
      ->check(Positive())
      ->default_str("a fortieth of the longest side");
}

}  // namespace simwright::cli
