#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "made_photos.h"

namespace simwright::bench {

// An object of a catalogue that was not used in training.
struct HeldOutPiece {
  std::string catalogue;  // file name below the furniture folder
  std::string id, name;   // from the catalogue
};

// Returns the objects of BlendSwap-CC-BY.sh3f and KatorLegaz.sh3f (in this order, and in the
// catalogues' own) that
//   - are 3 cm to 0.9 m long,
//   - have a name in the knowledge base that no object of the training catalogue
//     BlendSwap-CC-0.sh3f has (case-insensitive): the split is by object,
//   - are the first of their name,
//   - have a texture, a colour that is not grey, or two colours.
// More than `limit` are thinned uniformly. Throws core::Error if a catalogue cannot be read.
std::vector<HeldOutPiece> ChooseHeldOut(const std::filesystem::path& furniture, int limit);

// Reads and writes lists with one object per line: catalogue, id and name, separated by tabs; lines
// that begin with # are comments. Reading throws core::Error for a line of another form, or a file
// without objects.
std::vector<HeldOutPiece> ReadHeldOut(const std::filesystem::path& file);
void WriteHeldOut(const std::vector<HeldOutPiece>& pieces, const std::filesystem::path& file);

// Loads the objects' meshes and category priors, in the list's order. Throws core::Error if one is
// missing, has no mesh, or its name leads to no category.
std::vector<CatalogueObject> LoadHeldOut(const std::vector<HeldOutPiece>& pieces,
                                         const std::filesystem::path& furniture);

}  // namespace simwright::bench
