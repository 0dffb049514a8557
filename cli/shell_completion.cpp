#include "cli/shell_completion.h"

#include <functional>
#include <vector>

namespace simwright::cli {
namespace {

// An option as a shell sees it.
struct CompletedOption {
  std::vector<std::string> long_names, short_names;  // without dashes
  bool takes_value = false;
  std::vector<std::string> values;  // empty: any, and the names of files are offered
  std::string description;
};

// A subcommand with its path from the program, such as "scene generate"; empty for the program.
struct CompletedCommand {
  std::string path;
  std::string description;
  std::vector<std::string> subcommands;
  std::vector<CompletedOption> options;
};

// Returns the values of an option whose type is written as "TEXT:{a,b,c}".
std::vector<std::string> FixedValues(const std::string& type) {
  std::vector<std::string> values;
  const size_t open = type.find('{'), close = type.find('}');
  if (open == std::string::npos || close == std::string::npos || close < open) return values;
  std::string value;
  for (size_t i = open + 1; i <= close; ++i) {
    if (type[i] != ',' && i != close) {
      value += type[i];
    } else {
      values.push_back(value.substr(0, value.find("->")));
      value.clear();
    }
  }
  return values;
}

void Collect(const CLI::App& app, const std::string& path,
             std::vector<CompletedCommand>* commands) {
  CompletedCommand command{path, app.get_description(), {}, {}};
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_lnames().empty() && option->get_snames().empty()) continue;  // positional
    command.options.push_back({option->get_lnames(), option->get_snames(),
                               option->get_expected_max() > 0, FixedValues(option->get_type_name()),
                               option->get_description()});
  }
  const auto subcommands = app.get_subcommands(std::function<bool(const CLI::App*)>());
  for (const CLI::App* one : subcommands) command.subcommands.push_back(one->get_name());
  commands->push_back(command);
  for (const CLI::App* one : subcommands) {
    Collect(*one, path.empty() ? one->get_name() : path + " " + one->get_name(), commands);
  }
}

std::string Joined(const std::vector<std::string>& words, const std::string& separator) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
  return text;
}

std::vector<std::string> Dashed(const CompletedOption& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.short_names) names.push_back("-" + name);
  for (const std::string& name : option.long_names) names.push_back("--" + name);
  return names;
}

// Returns a clause of bash's `case` for each option of `command` that takes a value: its fixed
// values, or files.
std::string BashValueClauses(const CompletedCommand& command) {
  std::string text;
  for (const CompletedOption& option : command.options) {
    if (!option.takes_value) continue;
    std::vector<std::string> patterns;
    for (const std::string& name : Dashed(option)) {
      patterns.push_back("'" + command.path + " " + name + "'");
    }
    const std::string words =
        option.values.empty() ? "compgen -f" : "compgen -W '" + Joined(option.values, " ") + "'";
    text += "    " + Joined(patterns, "|") + ") COMPREPLY=($(" + words +
            " -- \"$current\")); return ;;\n";
  }
  return text;
}

// Returns the bash function _simwright. It finds the subcommand among the words before the cursor,
// then offers values after an option that takes them, options after a dash, else subcommands or
// files.
std::string BashFunction(const std::vector<CompletedCommand>& commands) {
  std::string subcommands, options, values;
  for (const CompletedCommand& command : commands) {
    const std::string key = "    '" + command.path + "') ";
    if (!command.subcommands.empty()) {
      subcommands += key + "subcommands='" + Joined(command.subcommands, " ") + "' ;;\n";
    }
    std::vector<std::string> names;
    for (const CompletedOption& option : command.options) {
      for (const std::string& name : Dashed(option)) names.push_back(name);
    }
    options += key + "options='" + Joined(names, " ") + "' ;;\n";
    values += BashValueClauses(command);
  }
  return "_simwright_subcommands() {\n  subcommands=''\n  case \"$1\" in\n" + subcommands +
         "  esac\n}\n"
         "_simwright() {\n"
         "  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD-1]}\n"
         "  local path='' subcommands='' options='' i\n"
         "  COMPREPLY=()\n"
         "  for ((i = 1; i < COMP_CWORD; ++i)); do\n"
         "    _simwright_subcommands \"$path\"\n"
         "    case \" $subcommands \" in\n"
         "      *\" ${COMP_WORDS[i]} \"*) path=${path:+$path }${COMP_WORDS[i]} ;;\n"
         "    esac\n"
         "  done\n"
         "  case \"$path $previous\" in\n" +
         values + "  esac\n  case \"$path\" in\n" + options +
         "  esac\n"
         "  _simwright_subcommands \"$path\"\n"
         "  case \"$current\" in\n"
         "    -*) COMPREPLY=($(compgen -W \"$options\" -- \"$current\")) ;;\n"
         "    *)\n"
         "      if [ -n \"$subcommands\" ]; then\n"
         "        COMPREPLY=($(compgen -W \"$subcommands\" -- \"$current\"))\n"
         "      else\n"
         "        COMPREPLY=($(compgen -f -- \"$current\"))\n"
         "      fi ;;\n"
         "  esac\n"
         "}\n";
}

std::string FishQuoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\') quoted += '\\';
    quoted += c == '\n' ? ' ' : c;
  }
  return quoted + "'";
}

// Returns the condition of fish under which `path` is the subcommand on the line.
std::string FishCondition(const CompletedCommand& command) {
  if (command.path.empty()) return "__fish_use_subcommand";
  std::string condition;
  std::string word;
  for (const char c : command.path + " ") {
    if (c != ' ') {
      word += c;
      continue;
    }
    condition += (condition.empty() ? "" : "; and ") + ("__fish_seen_subcommand_from " + word);
    word.clear();
  }
  return condition;
}

std::string FishScript(const std::vector<CompletedCommand>& commands) {
  std::string text;
  for (const CompletedCommand& command : commands) {
    const std::string begin = "complete -c simwright -n " + FishQuoted(FishCondition(command));
    for (const CompletedCommand& one : commands) {
      for (const std::string& name : command.subcommands) {
        if (one.path != (command.path.empty() ? name : command.path + " " + name)) continue;
        const std::string unchosen =
            command.path.empty()
                ? begin
                : "complete -c simwright -n " +
                      FishQuoted(FishCondition(command) + "; and not __fish_seen_subcommand_from " +
                                 Joined(command.subcommands, " "));
        text += unchosen + " -f -a " + name + " -d " + FishQuoted(one.description) + "\n";
      }
    }
    for (const CompletedOption& option : command.options) {
      std::string line = begin;
      for (const std::string& name : option.short_names) line += " -s " + name;
      for (const std::string& name : option.long_names) line += " -l " + name;
      if (option.takes_value) line += " -r";
      if (!option.values.empty()) line += " -f -a " + FishQuoted(Joined(option.values, " "));
      text += line + " -d " + FishQuoted(option.description) + "\n";
    }
  }
  return text;
}

}  // namespace

std::string ShellCompletion(const CLI::App& app, Shell shell) {
  std::vector<CompletedCommand> commands;
  Collect(app, "", &commands);
  switch (shell) {
    case Shell::kBash:
      return "# bash completion for simwright\n" + BashFunction(commands) +
             "complete -o filenames -o bashdefault -F _simwright simwright\n";
    case Shell::kZsh:
      // zsh runs bash's functions by its own bashcompinit.
      return "#compdef simwright\nautoload -U +X bashcompinit && bashcompinit\n" +
             BashFunction(commands) + "complete -o filenames -F _simwright simwright\n" +
             "_bash_complete -o filenames -F _simwright\n";
    case Shell::kFish:
      return "# fish completion for simwright\n" + FishScript(commands);
  }
  return "";
}

}  // namespace simwright::cli
