#pragma once

#include <string>
#include <string_view>

namespace simwright::tasks {

// What a line of an answer begins with.
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

// A line that is no code, without its Markdown.
struct LabelledLine {
  Label label = Label::kNone;
  int number = 0;        // that of "Task 2", or of "2. ..."; 0: none
  std::string text;      // behind the label, unquoted
  bool heading = false;  // by '#', or all of it bold
  bool item = false;     // of a list
  int level = 0;         // of headings and items: the smaller one encloses the larger one
};

// Labels are known in English, German, French, Spanish, Portuguese, Italian, Russian, Chinese,
// Japanese and Korean.
LabelledLine ReadLabel(std::string_view line);

}  // namespace simwright::tasks
