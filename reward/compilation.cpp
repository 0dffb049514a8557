#include <algorithm>
#include <cstdio>
#include <set>

#include "core/error.h"
#include "reward/frontend/parameter_shapes.h"
#include "reward/frontend/parameter_usage.h"
#include "reward/frontend/parser.h"
#include "reward/frontend/spelling.h"
#include "reward/ir/code_generation.h"
#include "reward/reward_program.h"

namespace simwright::reward {
namespace {

// Returns the reward function. Functions that no other function of the file calls come first, then
// names closer to compute_reward.
const Function& FindEntry(const Module& module, const RewardOptions& options) {
  std::vector<std::string> names;
  const Function* best = nullptr;
  int best_rank = -1;
  const std::set<std::string> called = CalledNames(module);
  for (const auto& function : module.functions) {
    names.push_back(function->name);
    if (!options.entry.empty()) {
      if (function->name == options.entry) best = function.get();
      continue;
    }
    const std::string& name = function->name;
    int rank = 0;
    if (name.find("reward") != std::string::npos) rank = 1;
    if (name.find("compute_reward") != std::string::npos) rank = 2;
    if (name == "compute_reward") rank = 3;
    if (!called.contains(name)) rank += 4;
    if (rank >= best_rank) {
      best = function.get();
      best_rank = rank;
    }
  }
  if (best != nullptr) return *best;
  if (names.empty()) {
    Fail("no-function", {},
         "there is no function here; a program begins with def compute_reward(env):");
  }
  Fail("no-function", {},
       "there is no function '" + options.entry + "'" + Suggestion(options.entry, names));
}

bool HasError(const core::Findings& findings) {
  return std::any_of(findings.begin(), findings.end(), [](const core::Finding& finding) {
    return finding.severity == core::Severity::kError;
  });
}

core::Finding FindingOf(const Fault& fault) {
  return {fault.code, core::Severity::kError,
          std::to_string(fault.position.line) + ":" + std::to_string(fault.position.column),
          fault.sentence, 0.0};
}

// Returns the finding for a parameter of undetermined width: a sum over a row does not depend on
// its length.
core::Finding AssumedWidth(const Parameter& parameter, const RewardOptions& shaped) {
  const int width = shaped.parameter_shapes.at(parameter.name)[0];
  return {"assumed-width", core::Severity::kInfo,
          std::to_string(parameter.position.line) + ":" + std::to_string(parameter.position.column),
          "nothing here says how wide '" + parameter.name + "' is: [N, " + std::to_string(width) +
              "] is assumed; give its shape where it is another",
          static_cast<double>(width)};
}

CompileOutcome Compile(std::string_view source, const RewardScene* scene,
                       const RewardOptions& options) {
  CompileOutcome outcome;
  const Module module = Parse(source, options);
  const Function& entry = FindEntry(module, options);
  RewardOptions shaped = options;
  const std::vector<const Parameter*> assumed = InferParameterShapes(module, entry, scene, &shaped);
  Elaborator elaborator(module, scene, shaped);
  const ElaboratedOutputs outputs = elaborator.Run(entry);
  outcome.findings = elaborator.findings();
  for (const Parameter* parameter : assumed) {
    outcome.findings.push_back(AssumedWidth(*parameter, shaped));
  }
  if (HasError(outcome.findings)) return outcome;
  Code code = GenerateCode(elaborator, outputs, shaped);
  code.entry = entry.name;
  outcome.program.emplace(std::make_shared<const Code>(std::move(code)));
  return outcome;
}

}  // namespace

CompileOutcome CompileReward(std::string_view source, const RewardScene* scene,
                             const RewardOptions& options) {
  std::string error;
  if (!options.IsValid(&error)) throw core::Error(error, "reward options");
  try {
    return Compile(source, scene, options);
  } catch (const Fault& fault) {
    CompileOutcome outcome;
    outcome.findings.push_back(FindingOf(fault));
    return outcome;
  }
}

namespace {

// Replaces characters that would move a terminal's cursor or change its colours: both bytes of the
// control characters U+0080 to U+009F, and those below the blank except the tab.
std::string Harmless(std::string_view text) {
  std::string shown(text);
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const auto byte = static_cast<unsigned char>(shown[i]);
    if ((byte < 0x20 && byte != '\t') || byte == 0x7F) shown[i] = '?';
    const bool second = i > 0 && static_cast<unsigned char>(shown[i - 1]) == 0xC2 && byte < 0xA0;
    if (second && byte >= 0x80) {
      shown[i - 1] = '?';
      shown.erase(i--, 1);
    }
  }
  return shown;
}

}  // namespace

std::string RenderFinding(const core::Finding& finding, std::string_view source) {
  const char* severity = finding.severity == core::Severity::kError     ? "error"
                         : finding.severity == core::Severity::kWarning ? "warning"
                                                                        : "note";
  std::string text = finding.place + ": " + severity + ": " + Harmless(finding.sentence) + "\n";
  int line = 0, column = 0;
  if (std::sscanf(finding.place.c_str(), "%d:%d", &line, &column) != 2 || line < 1) return text;
  for (int i = 1; i < line; ++i) {
    const std::size_t end = source.find('\n');
    if (end == std::string_view::npos) return text;
    source.remove_prefix(end + 1);
  }
  std::string_view shown = source.substr(0, source.find('\n'));
  if (shown.ends_with('\r')) shown.remove_suffix(1);
  constexpr std::size_t kWidest = 400;
  if (shown.size() > kWidest) return text;
  std::string caret;
  int at = 1;
  for (const char c : shown) {
    if (at >= column) break;
    if ((static_cast<unsigned char>(c) & 0xC0) == 0x80) continue;  // inside a character
    caret += c == '\t' ? '\t' : ' ';
    ++at;
  }
  return text + "    " + Harmless(shown) + "\n    " + caret + "^\n";
}

}  // namespace simwright::reward
