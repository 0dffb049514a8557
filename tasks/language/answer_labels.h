#pragma once

#include <string>
#include <string_view>

namespace simwright::tasks {

// The label that begins a line of an answer.
enum class Label {
  kNone,
  kTask,                // "Task 2: ..."
  kSubtask,             // "Sub-task 1 - ..."
  kTaskDescription,     // "Task Description: ..."
  kSubtaskDescription,  // "Subtask Description: ..."
  kDescription,         // "Description: ..."
  kSuccess,             // "Success condition: ..."
  kGoal,                // "Goal: [x, y, z]"
  kPlan,                // "Subtasks:"
  kName,                // "Name: ..."
  kCode,                // "Reward function for ...:"
};

// A line of an answer that is not code, without its Markdown.
struct LabelledLine {
  Label label = Label::kNone;
  int number = 0;        // the number of "Task 2" or "2. ..."; 0: none
  std::string text;      // the text after the label, unquoted
  bool heading = false;  // marked by '#', or bold as a whole
  bool item = false;     // a list item
  int level = 0;         // nesting level of headings and items; a smaller level encloses a larger
                         // one
};

// Parses a line of an answer. Recognizes labels in English, German, French, Spanish, Portuguese,
// Italian, Russian, Chinese, Japanese and Korean.
LabelledLine ReadLabel(std::string_view line);

}  // namespace simwright::tasks
