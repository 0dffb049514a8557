#include "tasks/language/answer_titles.h"

#include <string_view>

#include "tasks/language/answer_text.h"

namespace simwright::tasks {

bool IsSectionTitle(const std::string& title) {
  const std::string lower = Lower(title);
  for (const char* word : {"tasks", "reward", "answer", "solution", "python", "output", "overview",
                           "explanation", "notes", "summary", "assets", "environment",
                           "instructions", "example", "question", "decomposition", "description"}) {
    if (lower == word || lower.find(std::string(word) + " function") != std::string::npos) {
      return true;
    }
  }
  return lower.ends_with(" tasks") || lower.find(" tasks ") != std::string::npos ||
         lower.starts_with("tasks ") || lower == "code" || lower.ends_with(" code") ||
         lower == "task" || lower == "reward functions";
}

std::string TitleOfFunction(std::string name) {
  for (const std::string_view part :
       {"compute_reward_for_", "compute_reward_", "reward_for_", "reward_function_", "get_reward_",
        "calculate_reward_", "reward_", "compute_"}) {
    if (name.starts_with(part)) {
      name.erase(0, part.size());
      break;
    }
  }
  for (const std::string_view part : {"_reward_function", "_reward", "_function"}) {
    if (name.ends_with(part)) name.erase(name.size() - part.size());
  }
  const bool version = name.size() <= 3 && name.find_first_of("0123456789") != std::string::npos;
  return version || name == "compute_reward" || name == "reward" || name == "compute" ? "" : name;
}

std::string TitlePart(const std::string& text) {
  const std::size_t colon = text.find(": ");
  return Unquoted(std::string_view(text).substr(0, colon));
}

}  // namespace simwright::tasks
