#include "tasks/language/outline_tasks.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <deque>
#include <optional>
#include <string>

#include "tasks/language/answer_text.h"
#include "tasks/language/answer_titles.h"
#include "tasks/language/program_blocks.h"
#include "tasks/language/stated_goal.h"

namespace simwright::tasks {
namespace {

constexpr std::size_t kLongestOutlineTitle = 100;  // bytes; a longer text is a description
constexpr std::size_t kMostPlanned = 30;
// Limits on what is collected, far above the number that is kept of an answer.
constexpr std::size_t kMostOutlineTasks = 300, kMostSubtasks = 3000;
constexpr int kCommentLevel = 9;  // below every heading level, above every list level

struct Heading {
  std::string title;
  int level = 0;
  bool item = false;         // a plain list item, which may also be an explanation
  std::ptrdiff_t task = -1;  // index of the task made from it
};

class TaskAssembler {
 public:
  bool full() const { return tasks_.size() >= kMostOutlineTasks || subtasks_ >= kMostSubtasks; }

  void Take(const OutlineEntry& entry) {
    if (!entry.program.empty()) {
      TakeProgram(entry);
      return;
    }
    const LabelledLine& line = entry.line;
    if (line.label != Label::kNone || !line.item) in_plan_ = in_plan_ && line.item;
    switch (line.label) {
      case Label::kTask:
        BeginTask(line.text, line.heading ? line.level : 0);
        break;
      case Label::kSubtask:
        BeginSubtask(line);
        break;
      case Label::kTaskDescription:
      case Label::kSubtaskDescription:
      case Label::kDescription:
        TakeDescription(line);
        break;
      case Label::kSuccess:
        *(OpenSubtask() != nullptr ? &OpenSubtask()->success : &success_) = line.text;
        break;
      case Label::kGoal:
        goal_ = StatedGoal(line.text);
        if (Subtask* open = OpenSubtask(); open != nullptr && goal_) open->goal = goal_;
        break;
      case Label::kPlan:
        TakePlan(line);
        break;
      case Label::kName:
        TakeName(line);
        break;
      case Label::kCode:
        if (!line.text.empty() && line.text.size() <= kLongestOutlineTitle && line.heading) {
          TakeHeading(line.text, line.level);
        }
        break;
      case Label::kNone:
        TakePlain(line);
        break;
    }
  }

  std::vector<Task> Finish() {
    for (std::size_t i = 0; i < tasks_.size(); ++i) {
      Task& task = tasks_[i];
      if (!task.subtasks.empty()) continue;
      for (const std::string& title : plans_[i]) AddSubtask(&task, title);
      if (task.subtasks.empty()) AddSubtask(&task, task.name);
    }
    return WithoutDuplicates();
  }

 private:
  static bool HasProgram(const Task& task) {
    return std::any_of(task.subtasks.begin(), task.subtasks.end(),
                       [](const Subtask& subtask) { return !subtask.program.empty(); });
  }

  // Returns the tasks without those that an overview named and that appear again with their
  // programs.
  std::vector<Task> WithoutDuplicates() {
    std::vector<Task> kept;
    for (Task& task : tasks_) {
      const bool duplicate =
          !HasProgram(task) && std::any_of(tasks_.begin(), tasks_.end(), [&](const Task& other) {
            return HasProgram(other) && Lower(other.name) == Lower(task.name);
          });
      if (!duplicate) kept.push_back(task);
    }
    return kept;
  }

  Subtask* AddSubtask(Task* task, const std::string& title) {
    Subtask subtask;
    subtask.name = title;
    ++subtasks_;
    task->subtasks.push_back(std::move(subtask));
    return &task->subtasks.back();
  }

  // Returns the subtask that was named and has no program yet; null: none.
  Subtask* OpenSubtask() {
    return subtask_open_ && !tasks_.empty() ? &tasks_.back().subtasks.back() : nullptr;
  }

  void ForgetLines() {
    headings_since_ = false;
    items_.clear();
    title_line_.clear();
  }

  void BeginTask(const std::string& title, int level) {
    // "Task Name:" may stand below "Task 1".
    const bool names_last = !tasks_.empty() && labelled_ && tasks_.back().name.empty() &&
                            tasks_.back().subtasks.empty() && !title.empty();
    if (!names_last) {
      tasks_.emplace_back();
      plans_.emplace_back();
    }
    tasks_.back().name = title;
    labelled_ = true;
    task_level_ = level;
    subtask_open_ = false;
    first_number_ = 0;
    description_.clear();
    success_.clear();
    goal_.reset();
    queue_.clear();
    headings_.clear();
    wants_description_ = false;
    ForgetLines();
  }

  void BeginSubtask(const LabelledLine& line) {
    const bool restarts = line.number == 1 && first_number_ == 1 && !tasks_.empty() &&
                          HasProgram(tasks_.back()) && !subtask_open_;
    const std::string above = headings_since_ ? headings_.back().title : "";
    if (!above.empty() && (tasks_.empty() || HasProgram(tasks_.back()))) {
      const std::string description = description_;
      BeginTask(above, headings_.empty() ? 0 : headings_.back().level);
      tasks_.back().description = description;
    } else if (tasks_.empty() || restarts) {
      BeginTask("", 0);
    }
    if (first_number_ == 0) first_number_ = line.number;
    description_.clear();
    AddSubtask(&tasks_.back(), line.text);
    subtask_open_ = true;
    labelled_ = true;
    wants_description_ = false;
    ForgetLines();
  }

  std::string* DescriptionPlace(Label label) {
    if (tasks_.empty() || (headings_since_ && label == Label::kDescription && !subtask_open_)) {
      return &description_;
    }
    if (label != Label::kTaskDescription && subtask_open_) return &OpenSubtask()->description;
    if (HasProgram(tasks_.back()) && label != Label::kTaskDescription) return &description_;
    return &tasks_.back().description;
  }

  void TakeDescription(const LabelledLine& line) {
    *DescriptionPlace(line.label) = line.text;
    wants_description_ = line.text.empty();
    description_label_ = line.label;
  }

  void TakePlan(const LabelledLine& line) {
    if (headings_since_ && (tasks_.empty() || HasProgram(tasks_.back()))) {
      BeginTask(headings_.back().title, headings_.back().level);
    }
    in_plan_ = labelled_;  // otherwise the following list is an ordinary one
    if (!in_plan_) return;
    std::string_view rest = line.text;
    while (!rest.empty()) {
      const std::size_t end = rest.find_first_of(",;");
      PlanSubtask(std::string(rest.substr(0, end)));
      rest = end == std::string_view::npos ? "" : rest.substr(end + 1);
    }
  }

  void PlanSubtask(const std::string& text) {
    const std::string title = TitlePart(text);
    if (tasks_.empty() || title.empty() || plans_.back().size() >= kMostPlanned) return;
    plans_.back().push_back(title);
  }

  // Handles "name: open_door", as in YAML lists.
  void TakeName(const LabelledLine& line) {
    if (line.text.empty()) return;
    if (Subtask* open = OpenSubtask(); open != nullptr && open->name.empty()) {
      open->name = line.text;
    } else if (!tasks_.empty() && tasks_.back().name.empty() && tasks_.back().subtasks.empty()) {
      tasks_.back().name = line.text;
    } else if (line.item && !tasks_.empty() && labelled_ && task_level_ > 0 &&
               line.level > task_level_) {
      BeginSubtask(line);
    } else {
      BeginTask(line.text, line.item ? line.level : 0);
    }
  }

  void TakeHeading(const std::string& title, int level) {
    const bool section =
        IsSectionTitle(title) || title.empty() || title.size() > kLongestOutlineTitle;
    if (section && headings_since_) return;  // "### Code" below "### Open the door"
    while (!headings_.empty() && headings_.back().level >= level) headings_.pop_back();
    if (section) return;
    headings_.push_back({title, level});
    headings_since_ = true;
    description_.clear();
    items_.clear();
    queue_.clear();
  }

  void TakeItem(const LabelledLine& line) {
    if (in_plan_) {
      PlanSubtask(line.text);
      return;
    }
    if (!items_.empty() && items_.back().level != line.level) {
      const Heading enclosing = items_.back();
      items_.clear();
      outer_item_.reset();
      if (enclosing.level < line.level) outer_item_ = enclosing;
    }
    const std::string title = TitlePart(line.text);
    if (!title.empty() && title.size() <= kLongestOutlineTitle)
      items_.push_back({title, line.level, true});
  }

  void TakePlain(const LabelledLine& line) {
    if (wants_description_ && !line.text.empty()) {
      *DescriptionPlace(description_label_) = line.text;
      wants_description_ = false;
    } else if (line.heading) {
      TakeHeading(TitlePart(line.text), line.level);
    } else if (line.item) {
      TakeItem(line);
    } else {
      TakeProse(line.text);
    }
  }

  // Handles plain text: the name after a bare "Task 1", a line that names the next program, or a
  // description.
  void TakeProse(const std::string& text) {
    if (tasks_.empty() || HasProgram(tasks_.back()) || headings_since_) {
      const bool title = text.size() <= 60 && !text.ends_with('.') && !text.ends_with(':') &&
                         !text.ends_with('!') && !text.ends_with(',') &&
                         std::count(text.begin(), text.end(), ' ') <= 6;
      if (title && !headings_since_) title_line_ = Unquoted(text);
    }
    if (!labelled_ && !headings_since_) return;
    if (text.ends_with(':') || text.find_first_of("{}|") != std::string::npos) return;
    if (Subtask* open = OpenSubtask(); open != nullptr && open->name.empty()) {
      open->name = Unquoted(text);
    } else if (!headings_since_ && !tasks_.empty() && tasks_.back().name.empty() &&
               tasks_.back().subtasks.empty() && text.size() <= kLongestOutlineTitle) {
      tasks_.back().name = Unquoted(text);
    } else if (std::string* place = DescriptionPlace(Label::kDescription); place->empty()) {
      *place = Unquoted(text);
    }
  }

  // Returns the title of the next program, from the lines since the last one.
  std::optional<Heading> TitleAbove(const OutlineEntry& entry) {
    if (headings_since_ && !headings_.empty()) return headings_.back();
    if (!entry.title.empty() && !IsSectionTitle(entry.title)) {
      return Heading{entry.title, kCommentLevel};
    }
    if (items_.size() == 1) return items_.front();
    if (items_.size() > 1) queue_.assign(items_.begin(), items_.end());
    if (labelled_ || queue_.empty()) return std::nullopt;
    const Heading next = queue_.front();
    queue_.pop_front();
    return next;
  }

  void Fill(Subtask* subtask, const OutlineEntry& entry) {
    subtask->program = entry.program;
    if (subtask->description.empty()) subtask->description = description_;
    if (subtask->success.empty()) subtask->success = success_;
    if (subtask->success.empty()) subtask->success = SuccessExpression(entry.program);
    if (!subtask->goal) subtask->goal = goal_;
    subtask_open_ = false;
    description_.clear();
    success_.clear();
    goal_.reset();
    wants_description_ = false;
    in_plan_ = false;
  }

  void TakeProgram(const OutlineEntry& entry) {
    if (Subtask* open = OpenSubtask()) {
      Fill(open, entry);
    } else {
      const std::optional<Heading> above = TitleAbove(entry);
      const bool outside =
          above && above->level < kCommentLevel && task_level_ > 0 && above->level <= task_level_;
      if (labelled_ && !tasks_.empty() && !outside) {
        FillOfTask(above, entry);
      } else {
        FillUnlabelled(above, entry);
      }
    }
    ForgetLines();
  }

  // Adds a program to a task that was named by its label.
  void FillOfTask(const std::optional<Heading>& above, const OutlineEntry& entry) {
    Task* task = &tasks_.back();
    if (Task* listed = FirstOfEmptyRun(); listed != nullptr && !above) {
      Fill(AddSubtask(listed, listed->name), entry);
      return;
    }
    const std::size_t number = task->subtasks.size();
    std::string title = above && !(number == 0 && above->item) ? above->title : "";
    if (title.empty() && number < plans_.back().size()) title = plans_.back()[number];
    if (title.empty()) title = TitleOfFunction(entry.function);
    if (number == 0 && (title.empty() || !above)) {
      title = plans_.back().empty() ? task->name : plans_.back()[0];
    }
    Fill(AddSubtask(task, title), entry);
  }

  // Returns the first of several consecutive tasks without a program; null: none.
  Task* FirstOfEmptyRun() {
    std::size_t first = tasks_.size();
    while (first > 0 && tasks_[first - 1].subtasks.empty()) --first;
    const bool run = tasks_.size() - first > 1 || listed_programs_;
    if (!run || first == tasks_.size()) {
      // The tasks of a run are filled from its front, so the empty ones are last.
      listed_programs_ = false;
      return nullptr;
    }
    listed_programs_ = true;
    return &tasks_[first];
  }

  // Adds a program of a task without a label, named by headings, a list, or nothing.
  void FillUnlabelled(const std::optional<Heading>& above, const OutlineEntry& entry) {
    labelled_ = false;
    if (!above) {
      std::string title = title_line_.empty() ? TitleOfFunction(entry.function) : title_line_;
      NewTask(title);
      Fill(AddSubtask(&tasks_.back(), title), entry);
      return;
    }
    Heading* parent = nullptr;
    for (Heading& heading : headings_) {
      if (heading.level < above->level) parent = &heading;
    }
    if (parent == nullptr && outer_item_ && outer_item_->level < above->level) {
      parent = &*outer_item_;
    }
    if (parent != nullptr) {
      if (parent->task < 0) parent->task = NewTask(parent->title);
      Task* task = &tasks_[static_cast<std::size_t>(parent->task)];
      Fill(AddSubtask(task, above->title), entry);
      return;
    }
    NewTask(above->title);
    if (!headings_.empty() && headings_.back().title == above->title) {
      headings_.back().task = static_cast<std::ptrdiff_t>(tasks_.size()) - 1;
    }
    Fill(AddSubtask(&tasks_.back(), above->title), entry);
  }

  std::ptrdiff_t NewTask(const std::string& title) {
    tasks_.emplace_back();
    plans_.emplace_back();
    tasks_.back().name = title;
    return static_cast<std::ptrdiff_t>(tasks_.size()) - 1;
  }

  std::vector<Task> tasks_;
  std::size_t subtasks_ = 0;                     // total of all tasks
  std::vector<std::vector<std::string>> plans_;  // per task: subtasks named in a list
  bool labelled_ = false;                        // the last task was named by its label
  int task_level_ = 0;                           // level of the last task's heading; 0: none
  int first_number_ = 0;                         // number of its first subtask
  bool subtask_open_ = false;  // its last subtask was named and has no program yet
  bool in_plan_ = false;
  bool listed_programs_ = false;
  std::vector<Heading> headings_;  // headings that enclose the current line, outermost first
  bool headings_since_ = false;    // a heading follows the last program
  std::vector<Heading> items_;     // items of the last list after the last program
  std::optional<Heading> outer_item_;
  std::deque<Heading> queue_;  // items of a list before unnamed programs
  std::string title_line_;
  std::string description_, success_;  // texts for the next program
  std::optional<Eigen::Vector3d> goal_;
  bool wants_description_ = false;  // "Description:" alone; its text is the next line
  Label description_label_ = Label::kDescription;
};

}  // namespace

std::vector<Task> TasksInOutline(const std::vector<OutlineEntry>& outline) {
  TaskAssembler assembler;
  for (const OutlineEntry& entry : outline) {
    if (!assembler.full()) assembler.Take(entry);
  }
  return assembler.Finish();
}

}  // namespace simwright::tasks
