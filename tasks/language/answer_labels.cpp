#include "tasks/language/answer_labels.h"

#include <algorithm>
#include <array>

#include "tasks/language/answer_text.h"

namespace simwright::tasks {
namespace {

// Headings by '#' have levels 1 to 6; a bold line ranks below them, and lists below that.
constexpr int kBoldLevel = 7, kListLevel = 10;

struct Word {
  std::string_view text;  // ASCII in lower case
  Label label;
};
// The longer of two words comes first if one is a prefix of the other.
constexpr std::array kWords = {
    Word{"subtask description", Label::kSubtaskDescription},
    Word{"sub-task description", Label::kSubtaskDescription},
    Word{"sub task description", Label::kSubtaskDescription},
    Word{"task description", Label::kTaskDescription},
    Word{"aufgabenbeschreibung", Label::kTaskDescription},
    Word{"任务描述", Label::kTaskDescription},
    Word{"任務描述", Label::kTaskDescription},
    Word{"description", Label::kDescription},
    Word{"beschreibung", Label::kDescription},
    Word{"descripci\u00F3n", Label::kDescription},
    Word{"descri\u00E7\u00E3o", Label::kDescription},
    Word{"descrizione", Label::kDescription},
    Word{"Описание", Label::kDescription},
    Word{"описание", Label::kDescription},
    Word{"描述", Label::kDescription},
    Word{"説明", Label::kDescription},
    Word{"설명", Label::kDescription},
    Word{"subtask decomposition", Label::kPlan},
    Word{"subtask order", Label::kPlan},
    Word{"decomposition", Label::kPlan},
    Word{"subtasks", Label::kPlan},
    Word{"sub-tasks", Label::kPlan},
    Word{"sub tasks", Label::kPlan},
    Word{"steps", Label::kPlan},
    Word{"subtask name", Label::kSubtask},
    Word{"subtask title", Label::kSubtask},
    Word{"subtask", Label::kSubtask},
    Word{"sub-task", Label::kSubtask},
    Word{"sub task", Label::kSubtask},
    Word{"teilaufgabe", Label::kSubtask},
    Word{"unteraufgabe", Label::kSubtask},
    Word{"sous-t\u00E2che", Label::kSubtask},
    Word{"subtarea", Label::kSubtask},
    Word{"subtarefa", Label::kSubtask},
    Word{"sottocompito", Label::kSubtask},
    Word{"Подзадача", Label::kSubtask},
    Word{"подзадача", Label::kSubtask},
    Word{"子任务", Label::kSubtask},
    Word{"子任務", Label::kSubtask},
    Word{"サブタスク", Label::kSubtask},
    Word{"하위 작업", Label::kSubtask},
    Word{"task name", Label::kTask},
    Word{"task title", Label::kTask},
    Word{"task", Label::kTask},
    Word{"aufgabe", Label::kTask},
    Word{"t\u00E2che", Label::kTask},
    Word{"tarea", Label::kTask},
    Word{"tarefa", Label::kTask},
    Word{"compito", Label::kTask},
    Word{"Задача", Label::kTask},
    Word{"задача", Label::kTask},
    Word{"任务", Label::kTask},
    Word{"任務", Label::kTask},
    Word{"タスク", Label::kTask},
    Word{"작업", Label::kTask},
    Word{"success condition", Label::kSuccess},
    Word{"success criterion", Label::kSuccess},
    Word{"success criteria", Label::kSuccess},
    Word{"success", Label::kSuccess},
    Word{"erfolg", Label::kSuccess},
    Word{"成功条件", Label::kSuccess},
    Word{"goal position", Label::kGoal},
    Word{"target position", Label::kGoal},
    Word{"goal", Label::kGoal},
    Word{"reward functions", Label::kCode},
    Word{"reward function", Label::kCode},
    Word{"reward code", Label::kCode},
    Word{"reward", Label::kCode},
    Word{"python code", Label::kCode},
    Word{"code", Label::kCode},
    Word{"name", Label::kName},
    Word{"title", Label::kName},
};

bool IsLabelDigit(char c) {
  return c >= '0' && c <= '9';
}

bool Skip(std::string_view what, std::string_view* text) {
  if (!text->starts_with(what)) return false;
  text->remove_prefix(what.size());
  return true;
}

// Consumes a number at the start, such as "12"; returns 0 if there is none or it exceeds 9999.
int TakeNumber(std::string_view* text) {
  int number = 0;
  for (int digits = 0; digits < 4 && !text->empty() && IsLabelDigit(text->front()); ++digits) {
    number = number * 10 + (text->front() - '0');
    text->remove_prefix(1);
  }
  return number;
}

// Consumes a list mark and the white space after it: "1.", "2)", "(3)", "1.2", "-", "*".
bool TakeListMark(std::string_view* text, int* number) {
  for (const std::string_view mark : {"- ", "* ", "+ ", "\u2022", "\u2013 "}) {
    if (Skip(mark, text)) {
      *text = Trimmed(*text);
      return true;
    }
  }
  std::string_view rest = *text;
  const bool bracket = Skip("(", &rest);
  int count = TakeNumber(&rest);
  if (count == 0) return false;
  while (rest.size() > 1 && rest[0] == '.' && IsLabelDigit(rest[1])) {
    rest.remove_prefix(1);
    count = TakeNumber(&rest);
  }
  const bool ended = Skip(")", &rest) || (!bracket && Skip(".", &rest)) || Skip("\u3001", &rest);
  if (!ended || (!rest.empty() && rest[0] != ' ' && rest[0] != '*' && rest[0] != '\t')) {
    return false;
  }
  *number = count;
  *text = Trimmed(rest);
  return true;
}

// Removes Markdown marks from `line` and records them in `labelled`.
std::string TakeMarkdown(std::string_view line, LabelledLine* labelled) {
  std::string_view text = Trimmed(line);
  const int indentation = Indentation(line);
  std::size_t hashes = 0;
  while (hashes < text.size() && text[hashes] == '#') ++hashes;
  if (hashes > 0) {
    labelled->heading = true;
    labelled->level = static_cast<int>(std::min<std::size_t>(hashes, 6));
    text = Trimmed(text.substr(hashes));
    while (text.ends_with('#')) text.remove_suffix(1);
  }
  const bool item = TakeListMark(&text, &labelled->number);
  if (item && !labelled->heading) {
    labelled->item = true;
    labelled->level = kListLevel + std::min(indentation, 200);
  }
  const std::string plain(Trimmed(text));
  std::string_view end = plain;
  while (end.ends_with(':') || end.ends_with('.')) end.remove_suffix(1);
  const bool bold = end.size() > 4 && ((end.starts_with("**") && end.ends_with("**")) ||
                                       (end.starts_with("__") && end.ends_with("__")));
  if (bold && !labelled->heading) {
    labelled->heading = true;
    labelled->level = item ? labelled->level : kBoldLevel;
  }
  std::string without_bold;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    if (plain.compare(i, 2, "**") == 0) {
      ++i;
    } else {
      without_bold += plain[i];
    }
  }
  return std::string(Trimmed(without_bold));
}

struct Separated {
  bool colon = false, other = false;
};

Separated TakeSeparator(std::string_view* text) {
  *text = Trimmed(*text);
  for (const std::string_view colon : {":", "\uFF1A"}) {
    if (Skip(colon, text)) return {true, false};
  }
  for (const std::string_view mark : {"-", "\u2013", "\u2014", ".", ")", "|", "=", "\u3002"}) {
    if (Skip(mark, text)) return {false, true};
  }
  return {};
}

// Consumes the number of "Task #2" or "Task 2.1" (the last part; `parts` receives the number of
// parts), or a Chinese number up to ten.
int TakeLabelNumber(std::string_view* text, int* parts) {
  *text = Trimmed(*text);
  Skip("#", text);
  constexpr std::array<std::string_view, 10> kChinese = {"一", "二", "三", "四", "五",
                                                         "六", "七", "八", "九", "十"};
  for (std::size_t i = 0; i < kChinese.size(); ++i) {
    if (Skip(kChinese[i], text)) return static_cast<int>(i) + 1;
  }
  int number = TakeNumber(text);
  for (*parts = 1; text->size() > 1 && (*text)[0] == '.' && IsLabelDigit((*text)[1]); ++*parts) {
    text->remove_prefix(1);
    number = TakeNumber(text);
  }
  return number;
}

// Parses the text after the label's word. Returns false if the word begins an ordinary sentence.
bool ReadAfterLabel(Label label, std::string_view rest, LabelledLine* line) {
  line->label = label;
  int parts = 1;
  const bool numbered = label != Label::kGoal && label != Label::kCode;
  const int number = numbered ? TakeLabelNumber(&rest, &parts) : 0;
  if (label == Label::kTask && parts > 1) line->label = Label::kSubtask;  // "Task 2.1"
  if (label == Label::kCode) {
    std::string_view of = Trimmed(rest);
    if (Skip("for ", &of) || Skip("of ", &of)) {
      while (of.ends_with(':')) of.remove_suffix(1);
      line->text = Unquoted(of);
      return line->heading || rest.ends_with(':');
    }
  }
  std::string_view bracketed = Trimmed(rest);
  const bool in_bracket = number > 0 && bracketed.starts_with('(');
  if (in_bracket) {
    while (bracketed.ends_with(':')) bracketed.remove_suffix(1);
    if (bracketed.ends_with(')')) bracketed.remove_suffix(1);
    line->text = Unquoted(bracketed.substr(1));
    line->number = number;
    return true;
  }
  const Separated by = TakeSeparator(&rest);
  rest = Trimmed(rest);
  const bool nothing = rest.empty();
  const bool stands = by.colon || (number > 0 && (by.other || nothing || line->heading)) ||
                      (nothing && line->heading);
  if (!stands) return false;
  if (number > 0) line->number = number;
  line->text = Unquoted(rest);
  return true;
}

}  // namespace

LabelledLine ReadLabel(std::string_view line) {
  LabelledLine labelled;
  const std::string plain = TakeMarkdown(line, &labelled);
  const std::string lower = Lower(plain);
  for (const Word& word : kWords) {
    if (!lower.starts_with(word.text)) continue;
    const std::string_view rest = std::string_view(plain).substr(word.text.size());
    if (!rest.empty() && ((rest[0] >= 'a' && rest[0] <= 'z') || rest[0] == '_')) continue;
    if (ReadAfterLabel(word.label, rest, &labelled)) return labelled;
    labelled.label = Label::kNone;
  }
  std::string_view text = plain;
  if (labelled.heading || labelled.item) {  // "Step 2: ..." is only a numbered item
    std::string_view rest = text;
    if (Lower(text).starts_with("step ")) {
      rest.remove_prefix(5);
      const int number = TakeNumber(&rest);
      if (number > 0 && TakeSeparator(&rest).colon) text = Trimmed(rest);
    }
    while (text.ends_with(':')) text.remove_suffix(1);
  }
  labelled.text = labelled.heading || labelled.item ? Unquoted(text) : std::string(text);
  return labelled;
}

}  // namespace simwright::tasks
