// Imports the corpus of damaged meshes and compares each asset with the truth (docs/import.md).
#include <algorithm>
#include <cstdio>
#include <map>
#include <string>

#include <CLI/CLI.hpp>

#include "core/error.h"
#include "core/files.h"
#include "tests/importers/damaged/damaged_corpus.h"
#include "tests/importers/damaged/specimen_file.h"

namespace simwright::damaged {
namespace {
namespace fs = std::filesystem;

using Counts = std::map<Verdict, int>;

void PrintTrial(const Recipe& recipe, const Trial& trial) {
  std::printf("%-70s %-16s sides %5.2f %%  volume %+6.2f %%  %5.1f s  %s\n", recipe.name.c_str(),
              Name(trial.verdict), 100.0 * trial.side_error, 100.0 * trial.volume_error,
              trial.seconds, trial.reason.c_str());
  if (trial.verdict != Verdict::kRight) {
    for (const core::Finding& finding : trial.findings) {
      std::printf("    [%s] %s\n", finding.code.c_str(), finding.sentence.c_str());
    }
  }
  std::fflush(stdout);
}

void PrintTable(const std::map<std::string, Counts>& by_damage) {
  std::printf("\n%-18s %6s %8s %12s %17s\n", "damage", "right", "refused", "wrong, said",
              "wrong in silence");
  for (const auto& [damage, counts] : by_damage) {
    const auto count = [&](Verdict verdict) {
      const auto found = counts.find(verdict);
      return found == counts.end() ? 0 : found->second;
    };
    std::printf("%-18s %6d %8d %12d %17d\n", damage.c_str(), count(Verdict::kRight),
                count(Verdict::kRefused), count(Verdict::kWrongAndSaid),
                count(Verdict::kWrongInSilence));
  }
}

// Imports the undamaged objects: what is wrong of them is no damage's fault.
void RunSound(const std::string& folder) {
  std::map<std::string, bool> seen;
  for (const Recipe& recipe : CorpusRecipes()) {
    if (!seen.emplace(recipe.kind, true).second) continue;
    Specimen sound = SoundSpecimen(recipe.kind, recipe.seed);
    sound.format = "ply";
    PrintTrial(recipe, ImportSpecimen(sound, "sound-" + recipe.kind, folder));
  }
}

int Run(const std::string& folder, const std::string& only, int first, int step, bool write) {
  std::map<std::string, Counts> by_damage;
  std::vector<double> seconds;
  const std::vector<Recipe> recipes = CorpusRecipes();
  for (std::size_t i = static_cast<std::size_t>(first); i < recipes.size();
       i += static_cast<std::size_t>(step)) {
    const Recipe& recipe = recipes[i];
    if (recipe.name.find(only) == std::string::npos) continue;
    const Specimen specimen = DamagedSpecimen(recipe);
    if (write) {
      std::printf("%s %zu faces\n", WriteSpecimen(specimen, recipe.name, folder).c_str(),
                  specimen.mesh.triangles.size());
      continue;
    }
    const Trial trial = ImportSpecimen(specimen, recipe.name, folder);
    PrintTrial(recipe, trial);
    seconds.push_back(trial.seconds);
    ++by_damage["(all files)"][trial.verdict];
    for (const std::string& damage : recipe.damages) ++by_damage[damage][trial.verdict];
  }
  if (seconds.empty()) return 0;
  PrintTable(by_damage);
  std::sort(seconds.begin(), seconds.end());
  std::printf("\n%zu files, median %.1f s\n", seconds.size(), seconds[seconds.size() / 2]);
  return by_damage["(all files)"][Verdict::kWrongInSilence] > 0 ? 1 : 0;
}

}  // namespace
}  // namespace simwright::damaged

int main(int argc, char** argv) {
  CLI::App app("Imports the corpus of damaged meshes and compares with the truth");
  std::string folder = "damaged_corpus", only;
  int first = 0, step = 1;
  bool sound = false, write = false;
  app.add_option("-o", folder, "Folder for the files and the assets");
  app.add_option("--only", only, "Only files whose name contains this");
  app.add_option("--first", first, "Number of the first file");
  app.add_option("--step", step, "Takes every n-th file from there");
  app.add_flag("--sound", sound, "Only imports the undamaged objects");
  app.add_flag("--write", write, "Only writes the files");
  CLI11_PARSE(app, argc, argv);
  try {
    std::filesystem::create_directories(folder);
    if (sound) {
      simwright::damaged::RunSound(folder);
      return 0;
    }
    return simwright::damaged::Run(folder, only, first, step, write);
  } catch (const simwright::core::Error& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
