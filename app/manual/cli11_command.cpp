#include "app/manual/cli11_command.h"

#include <iostream>
#include <set>
#include <sstream>

#include "trimtab/units/labelled.h"

namespace trimtab::manual {
namespace {

/// Reads what CLI11 prints for a value, such as "TEXT:{json,xml}", "ENUM:value in {auto->0,dis->4} OR {0,4}"
/// or "UINT:INT in [16 - 100]", into kind, words and range.
void readType(const std::string& type, Argument& a) {
  a.value = type.empty() ? "TEXT" : type.substr(0, type.find(':'));
  const std::size_t open = type.find('{'), close = type.find('}', open);
  if (open != std::string::npos && close != std::string::npos) {
    std::istringstream words(type.substr(open + 1, close - open - 1));
    for (std::string word; std::getline(words, word, ',');)
      a.choices.push_back(word.substr(0, word.find("->")));
  } else if (const std::size_t in = type.find('['); in != std::string::npos) {
    a.range = type.substr(in);
  } else if (const std::size_t more = type.find(':'); more != std::string::npos) {
    a.range = type.substr(more + 1);
  }
}

std::vector<std::string> namesOf(const std::set<CLI::Option*>& options) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options) names.push_back(option->get_name());
  return names;
}

Argument argumentOf(const CLI::Option& option) {
  Argument a;
  for (const std::string& name : option.get_snames()) a.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) a.names.push_back("--" + name);
  if (a.names.empty()) a.names.push_back(option.get_name());
  if (option.get_expected_max() != 0) readType(option.get_type_name(), a);
  a.text = option.get_description();
  a.unset = option.get_default_str();
  a.required = option.get_required();
  a.repeats = option.get_items_expected_max() > 1;
  a.needs = namesOf(option.get_needs());
  a.excludes = namesOf(option.get_excludes());
  return a;
}

}  // namespace

Command commandOf(const CLI::App& app, const std::string& name) {
  Command command{name, app.get_description(), {}, {}};
  for (const CLI::Option* option : app.get_options())
    if (!option->get_group().empty()) command.arguments.push_back(argumentOf(*option));
  for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; }))
    command.commands.push_back(commandOf(*sub, name + ' ' + sub->get_name()));
  return command;
}

void addManualOption(CLI::App& app, const std::string& name) {
  // An empty group hides it from --help. The callback runs before CLI11 asks for what is required.
  app.add_option_function<std::string>("--write-manual",
                                       [&app, name](const std::string& folder) {
                                         const auto written = writeManual(commandOf(app, name), folder);
                                         std::cerr << labelled(written.findings());
                                         if (!written) throw CLI::RuntimeError(1);
                                         throw CLI::Success();
                                       })
      ->group("");
}

}  // namespace trimtab::manual
