#include "cli/usage.h"

#include <algorithm>
#include <cstdio>

#include "cli/findings_output.h"
#include "core/finding.h"
#include "core/ranks.h"
#include "reward/frontend/spelling.h"

namespace simwright::cli {
namespace {

// Formats options as "  --seed UINT [1]", because CLI11's own "=1" reads as part of the type.
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option_opts(const CLI::Option* option) const override {
    std::string text;
    if (option->get_type_size() == 0) return text;
    if (!option->get_type_name().empty()) text += " " + get_label(option->get_type_name());
    if (option->get_expected_max() == CLI::detail::expected_max_vector_size) text += " ...";
    if (option->get_required()) return text + " " + get_label("REQUIRED");
    const std::string usual = option->get_default_str();
    const bool none = usual.empty() || usual == "\"\"" || usual == "[]" || usual == "{}";
    return text + " [" + (none ? "none" : usual) + "]";
  }
};

std::vector<const CLI::App*> SubcommandsOf(const CLI::App& app) {
  return app.get_subcommands(std::function<bool(const CLI::App*)>());
}

std::vector<std::string> NamesOf(const std::vector<const CLI::App*>& apps) {
  std::vector<std::string> names;
  for (const CLI::App* app : apps) names.push_back(app->get_name());
  return names;
}

std::vector<std::string> OptionsOf(const CLI::App& app, const std::string& prefix) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back(prefix + name);
    for (const std::string& name : option->get_snames()) {
      if (!prefix.empty()) names.push_back("-" + name);
    }
  }
  return names;
}

std::string FullName(const CLI::App& app) {
  return app.get_parent() == nullptr ? app.get_name()
                                     : FullName(*app.get_parent()) + " " + app.get_name();
}

std::string NearestHint(const std::string& name, const std::vector<std::string>& known) {
  const std::string nearest = reward::NearestName(name, known);
  return nearest.empty() ? "" : ", did you mean " + nearest + "?";
}

const CLI::App* FindSubcommand(const CLI::App& app, const std::string& name) {
  for (const CLI::App* one : SubcommandsOf(app)) {
    if (one->get_name() == name) return one;
  }
  return nullptr;
}

// Walks through the arguments as CLI11 does, up to the first unknown one.
class Walk {
 public:
  explicit Walk(const CLI::App& app) : app_(&app) {}

  // Returns the fault of the first unknown argument; empty if all are known.
  std::string Through(const std::vector<std::string>& arguments) {
    for (const std::string& argument : arguments) {
      const std::string fault = argument.size() > 1 && argument[0] == '-' && !IsNumber(argument)
                                    ? Option(argument)
                                    : Word(argument);
      if (!fault.empty()) return fault;
    }
    return "";
  }
  const CLI::App& app() const { return *app_; }

 private:
  static bool IsNumber(const std::string& text) {
    return text.find_first_not_of("-+.0123456789eE,") == std::string::npos;
  }

  std::string Option(const std::string& argument) {
    const std::string name = argument.substr(0, argument.find('='));
    const CLI::Option* option = app_->get_option_no_throw(name);
    if (option == nullptr && argument[1] != '-') {  // -oFILE
      option = app_->get_option_no_throw(argument.substr(0, 2));
      values_ = 0;
      if (option != nullptr && argument.size() > 2) return "";
    }
    if (option == nullptr) {
      return "unknown option " + name + " of '" + FullName(*app_) + "'" +
             NearestHint(name, OptionsOf(*app_, "--"));
    }
    values_ = argument.find('=') == std::string::npos ? option->get_items_expected_max() : 0;
    return "";
  }

  std::string Word(const std::string& argument) {
    if (values_ > 0) {
      --values_;
      return "";
    }
    const std::vector<const CLI::App*> known = SubcommandsOf(*app_);
    if (known.empty()) return "";
    const CLI::App* found = FindSubcommand(*app_, argument);
    if (found == nullptr) {
      return "unknown subcommand " + argument + " of '" + FullName(*app_) + "'" +
             NearestHint(argument, NamesOf(known));
    }
    app_ = found;
    return "";
  }

  const CLI::App* app_;
  int values_ = 0;  // values that the last option still takes
};

// Returns the fault of a configuration key, which CLI11 names as "lift.categroy", or as "KEY: This
// option is not allowed in a configuration file".
std::string ConfigFault(const CLI::App& app, const std::string& message) {
  const size_t refused = message.find(": This option is not allowed");
  if (refused != std::string::npos) {
    return "the key " + message.substr(0, refused) +
           " is not allowed in a configuration file: give it on the command line";
  }
  const size_t at = message.rfind(' ');
  std::string key = at == std::string::npos ? message : message.substr(at + 1);
  const CLI::App* section = &app;
  size_t dot;
  while ((dot = key.find('.')) != std::string::npos) {
    const std::string name = key.substr(0, dot);
    const CLI::App* next = FindSubcommand(*section, name);
    if (next == nullptr) {
      return "unknown section [" + name + "] of the configuration file" +
             NearestHint(name, NamesOf(SubcommandsOf(*section)));
    }
    section = next;
    key = key.substr(dot + 1);
  }
  return "unknown key " + key + " of the configuration file" +
         (section == &app ? ", outside of any section"
                          : ", section [" + section->get_name() + "]") +
         NearestHint(key, OptionsOf(*section, ""));
}

}  // namespace

void PrepareApp(CLI::App* app) {
  app->formatter(std::make_shared<HelpFormatter>());
  app->option_defaults()->always_capture_default();
  app->allow_config_extras(CLI::config_extras_mode::error);
}

std::vector<std::string> ArgumentsOf(int argc, char** argv) {
  std::vector<std::string> config, others;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--") {
      others.insert(others.end(), argv + i, argv + argc);
      break;
    }
    if (argument == "--config" && i + 1 < argc) {
      config = {argument, argv[++i]};
    } else if (argument.starts_with("--config=")) {
      config = {argument};
    } else {
      others.push_back(argument);
    }
  }
  config.insert(config.end(), others.begin(), others.end());
  return config;
}

std::string Diagnosis(const CLI::App& app, const std::vector<std::string>& arguments,
                      const CLI::ParseError& error) {
  const std::string message = error.what();
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ConfigError)) {
    return ConfigFault(app, message);
  }
  Walk walk(app);
  const std::string unknown = walk.Through(arguments);
  return unknown.empty() ? message : unknown;
}

int ReportUsage(const CLI::App& app, const std::vector<std::string>& arguments,
                const CLI::ParseError& error) {
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) {
    if (core::ThisRank().leads()) app.exit(error);  // help
    return 0;
  }
  Walk walk(app);
  walk.Through(arguments);
  const core::Finding finding{"error", core::Severity::kError,
                              "",      Diagnosis(app, arguments, error),
                              0.0,     FullName(walk.app()) + " --help lists the options"};
  PrintError(finding, /*json=*/false);
  return kWrongUsage;
}

CLI::Option* AddChoice(CLI::App* command, const std::string& option,
                       const std::vector<std::string>& names, const std::string& usual,
                       const std::string& description,
                       const std::function<void(const std::string&)>& take) {
  return command->add_option_function<std::string>(option, take, description)
      ->check(CLI::IsMember(names))
      ->default_str(usual);
}

}  // namespace simwright::cli
