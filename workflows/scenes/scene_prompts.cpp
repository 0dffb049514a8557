#include "workflows/scenes/scene_prompts.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <optional>
#include <sstream>

#include "core/files.h"
#include "physics_params/wordnet.h"
#include "scene/prompt/object_names.h"
#include "scene/prompt/prompt_agreement.h"
#include "scene/prompt/prompt_reading.h"
#include "scene/prompt/scene_type_words.h"

namespace simwright::workflows {
namespace {

// A prompt with its place for messages.
struct PlacedPrompt {
  std::string text, place;
};

// Reads the lines of a file that are not blank.
std::vector<PlacedPrompt> LinesOf(const std::filesystem::path& file) {
  std::vector<PlacedPrompt> lines;
  std::istringstream text(core::ReadFile(file));
  int number = 0;
  for (std::string line; std::getline(text, line);) {
    ++number;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.find_first_not_of(" \t") == std::string::npos) continue;
    lines.push_back({line, file.string() + ":" + std::to_string(number)});
  }
  if (lines.empty()) throw core::Error("it has no prompts", file.string(), "write one per line");
  return lines;
}

// Returns true for a text of a scene and nothing in it: "a scene".
bool IsBareScene(const std::string& text) {
  std::string letters;
  for (const char c : text) {
    if (std::isalpha(static_cast<unsigned char>(c))) {
      letters += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    } else if (!std::isspace(static_cast<unsigned char>(c)) && c != '.') {
      return false;
    }
  }
  return letters == "scene" || letters == "ascene" || letters == "thescene";
}

// Returns true if a scene has at least one object of each name that is asked for.
bool HasAllNames(const scene::Prompt& prompt, const std::vector<scene::SceneObject>& objects) {
  return std::all_of(prompt.names.begin(), prompt.names.end(), [&](const scene::NamedCount& one) {
    return one.count == 0 ||
           std::any_of(objects.begin(), objects.end(), [&](const scene::SceneObject& object) {
             return scene::NameOfCategory(object.category) == one.name;
           });
  });
}

PromptReport ReportOf(const scene::Prompt& prompt, size_t index, size_t prompts,
                      const std::vector<std::vector<scene::SceneObject>>& scenes,
                      const scene::CategorySizes& sizes, const std::vector<char>& counted) {
  PromptReport report;
  report.text = prompt.Text();
  for (const std::string& statement : StatementsOf(prompt)) {
    report.broken.push_back({statement, 0});
  }
  double held = 0.0;
  for (size_t i = index; i < scenes.size(); i += prompts) {
    if (!counted.empty() && counted[i] == 0) continue;
    const scene::PromptAgreement agreement = AgreementWith(prompt, scenes[i], sizes);
    ++report.scenes;
    report.apf += agreement.apf;
    report.strict += agreement.strict;
    report.complete += HasAllNames(prompt, scenes[i]) ? 1 : 0;
    report.statements = agreement.statements;
    held += agreement.StatementShare();
    for (size_t k = 0; k < agreement.holds.size(); ++k) {
      report.broken[k].scenes += agreement.holds[k] ? 0 : 1;
    }
  }
  std::erase_if(report.broken, [](const auto& one) { return one.scenes == 0; });
  if (report.scenes == 0) return report;
  report.apf /= report.scenes;
  report.strict /= report.scenes;
  report.held = held / report.scenes;
  return report;
}

}  // namespace

RequestedPrompts ReadPromptsAndTypes(const std::vector<std::string>& texts,
                                     const std::filesystem::path& file,
                                     const scene::Vocabulary& vocabulary,
                                     const std::vector<std::string>& types,
                                     core::Findings* findings) {
  std::vector<PlacedPrompt> placed;
  for (const std::string& text : texts) placed.push_back({text, "--prompt"});
  if (!file.empty()) {
    const std::vector<PlacedPrompt> lines = LinesOf(file);
    placed.insert(placed.end(), lines.begin(), lines.end());
  }
  RequestedPrompts requested;
  for (PlacedPrompt& one : placed) {
    const std::optional<std::string> type = scene::TakeSceneType(types, &one.text);
    requested.types.push_back(type.value_or(""));
    scene::PromptReading reading;
    try {
      if (!type || !IsBareScene(one.text)) {
        reading = ReadPrompt(one.text, vocabulary, physics_params::WordNet::Installed());
      }
    } catch (const core::Error& error) {
      throw core::Error(PromptErrorLine(error), one.place);
    }
    for (core::Finding finding : reading.findings) {
      finding.place = one.place;
      findings->push_back(std::move(finding));
    }
    requested.prompts.push_back(std::move(reading.prompt));
    requested.referred.push_back(std::move(reading.referred));
  }
  return requested;
}

std::vector<scene::Prompt> ReadPrompts(const std::vector<std::string>& texts,
                                       const std::filesystem::path& file,
                                       const scene::Vocabulary& vocabulary,
                                       core::Findings* findings) {
  return ReadPromptsAndTypes(texts, file, vocabulary, {}, findings).prompts;
}

std::string PromptErrorLine(const core::Error& error) {
  const std::string line = error.what(), place = "prompt: ";
  return line.starts_with(place) ? line.substr(place.size()) : line;
}

std::vector<std::string> StatementsOf(const scene::Prompt& prompt) {
  std::vector<std::string> statements;
  for (const auto& one : prompt.relations) statements.push_back(StatementText(one, prompt));
  for (const auto& one : prompt.tiers) statements.push_back(StatementText(one, prompt));
  return statements;
}

std::vector<std::string> TextsOf(const std::vector<scene::Prompt>& prompts) {
  std::vector<std::string> texts;
  for (const scene::Prompt& prompt : prompts) texts.push_back(prompt.Text());
  return texts;
}

std::vector<PromptReport> ReportsOf(const std::vector<scene::Prompt>& prompts,
                                    const std::vector<std::vector<scene::SceneObject>>& scenes,
                                    const scene::CategorySizes& sizes,
                                    const std::vector<char>& counted) {
  std::vector<PromptReport> reports;
  for (size_t i = 0; i < prompts.size(); ++i) {
    reports.push_back(ReportOf(prompts[i], i, prompts.size(), scenes, sizes, counted));
  }
  return reports;
}

std::string PromptTable(const std::vector<PromptReport>& reports) {
  std::string text;
  PromptReport all;
  for (const PromptReport& report : reports) {
    all.scenes += report.scenes;
    all.apf += report.scenes * report.apf;
    all.strict += report.scenes * report.strict;
    all.complete += report.complete;
    char line[160];
    std::snprintf(line, sizeof line, ": agreement %.2f, exact in %.0f %% of %d", report.apf,
                  100.0 * report.strict, report.scenes);
    text += "\"" + (report.text.empty() ? "(no prompt)" : report.text) + "\"" + line;
    if (report.statements > 0) {
      std::snprintf(line, sizeof line, ", %.0f %% of the relations hold", 100.0 * report.held);
      text += line;
    }
    text += "\n";
    for (const PromptReport::Broken& one : report.broken) {
      text += "  does not hold in " + std::to_string(one.scenes) + " of " +
              std::to_string(report.scenes) + ": " + one.statement + "\n";
    }
  }
  if (reports.size() > 1 && all.scenes > 0) {
    char line[160];
    std::snprintf(line, sizeof line,
                  "all prompts: agreement %.2f, exact in %.0f of %d, every name in %d of %d\n",
                  all.apf / all.scenes, all.strict, all.scenes, all.complete, all.scenes);
    text += line;
  }
  return text;
}

core::OrderedJson PromptJson(const std::vector<PromptReport>& reports) {
  core::OrderedJson json = core::OrderedJson::array();
  for (const PromptReport& report : reports) {
    core::OrderedJson broken = core::OrderedJson::array();
    for (const PromptReport::Broken& one : report.broken) {
      broken.push_back({{"statement", one.statement}, {"scenes", one.scenes}});
    }
    json.push_back({{"prompt", report.text},
                    {"scenes", report.scenes},
                    {"apf", report.apf},
                    {"strict_share", report.strict},
                    {"scenes_with_every_name", report.complete},
                    {"relations", report.statements},
                    {"relations_held_share", report.held},
                    {"relations_broken", broken}});
  }
  return json;
}

}  // namespace simwright::workflows
