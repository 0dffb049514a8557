#include "workflows/priors/models_folder.h"

#include <cstdlib>

namespace simwright::workflows {
namespace fs = std::filesystem;

fs::path ModelsFolder() {
  if (const char* told = std::getenv("SIMWRIGHT_MODELS"); told != nullptr && *told != '\0') {
    return told;
  }
  std::error_code none;
  const fs::path program = fs::read_symlink("/proc/self/exe", none);
  if (none) return {};
  const fs::path folder = program.parent_path();
  for (const fs::path& candidate :
       {folder / ".." / "share" / "simwright" / "models", folder / ".." / ".." / "models"}) {
    if (fs::is_directory(candidate, none)) return candidate.lexically_normal();
  }
  return {};
}

}  // namespace simwright::workflows
