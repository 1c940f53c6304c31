#include <filesystem>

#include "app/manual/command.h"
#include "trimtab/preset/preset.h"

namespace trimtab::manual {
namespace {

/// Text that roff prints as it is: a bare "-" would become a hyphen, which nobody can paste into a shell, and
/// a dot or a quote at the start of a line would be a request.
std::string plain(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if ((c == '.' || c == '\'') && (out.empty() || out.back() == '\n')) out += "\\&";
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
  }
  return out;
}

std::string bold(const std::string& text) {
  return "\\fB" + plain(text) + "\\fR";
}
std::string italic(const std::string& text) {
  return "\\fI" + plain(text) + "\\fR";
}

std::string pageName(const std::string& command) {
  std::string name = command;
  for (char& c : name)
    if (c == ' ') c = '-';
  return name;
}

std::string joined(const std::vector<std::string>& words, const char* between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

std::string synopsis(const Command& command) {
  std::string text = bold(command.name) + " [" + italic("OPTION") + "...]";
  const auto add = [&text](const Argument& a, const std::string& shown) {
    const std::string whole = shown + (a.repeats ? "..." : "");
    text += a.required ? ' ' + whole : " [" + whole + ']';
  };
  for (const Argument& a : command.arguments)
    if (!a.positional() && a.required)
      text += ' ' + bold(a.names.back()) + ' ' + italic(a.value) + (a.repeats ? "..." : "");
  for (const Argument& a : command.arguments)
    if (a.positional()) add(a, italic(a.names.front()));
  if (!command.commands.empty()) text += ' ' + italic("COMMAND");
  return text;
}

/// One entry of a list: its heading, and the sentences below it.
std::string entry(const Argument& a) {
  std::string out = ".TP\n";
  if (a.positional()) {
    out += italic(a.names.front());
  } else {
    std::string names;
    for (const std::string& name : a.names) names += (names.empty() ? "" : ", ") + bold(name);
    out += names + (a.value.empty() ? "" : ' ' + italic(a.value));
  }
  std::vector<std::string> sentences;
  if (!a.text.empty()) sentences.push_back(a.text + (a.text.ends_with('.') ? "" : "."));
  if (!a.choices.empty()) sentences.push_back("One of: " + joined(a.choices, ", ") + '.');
  if (!a.range.empty()) sentences.push_back("Allowed: " + a.range + '.');
  if (!a.unset.empty()) sentences.push_back("Default: " + a.unset + '.');
  if (a.required) sentences.push_back("Required.");
  if (!a.needs.empty()) sentences.push_back("Needs " + joined(a.needs, " and ") + '.');
  if (!a.excludes.empty()) sentences.push_back("Not together with " + joined(a.excludes, " or ") + '.');
  return out + '\n' + plain(joined(sentences, "\n")) + '\n';
}

std::string seeAlso(const Command& command) {
  std::vector<std::string> pages;
  if (const std::size_t space = command.name.rfind(' '); space != std::string::npos)
    pages.push_back(command.name.substr(0, space));
  for (const Command& sub : command.commands) pages.push_back(sub.name);
  const std::string program = command.name.substr(0, command.name.find(' '));
  for (const char* other : {"trimtab", "trimtab-cli", "trimtab-ig"})
    if (program != other) pages.push_back(other);
  std::string text;
  for (const std::string& page : pages) text += (text.empty() ? "" : ",\n") + bold(pageName(page)) + "(1)";
  return text;
}

}  // namespace

std::string manPage(const Command& command) {
  std::string out = ".\\\" Written from the program's table of options.\n.TH " + pageName(command.name) +
                    " 1 \"\" \"Trimtab " TRIMTAB_VERSION "\" \"Trimtab manual\"\n.SH NAME\n" +
                    plain(pageName(command.name)) + " \\- " + plain(command.text) + "\n.SH SYNOPSIS\n" +
                    synopsis(command) + '\n';
  std::string positionals, options;
  for (const Argument& a : command.arguments) (a.positional() ? positionals : options) += entry(a);
  if (!command.commands.empty()) {
    out += ".SH COMMANDS\n";
    for (const Command& sub : command.commands)
      out += ".TP\n" + bold(sub.name.substr(sub.name.rfind(' ') + 1)) + '\n' + plain(sub.text) + ".\nSee " +
             bold(pageName(sub.name)) + "(1).\n";
  }
  if (!positionals.empty()) out += ".SH ARGUMENTS\n" + positionals;
  if (!options.empty()) out += ".SH OPTIONS\n" + options;
  return out +
         ".SH EXIT STATUS\n0: done. 1: input was refused, or a check failed. 2: wrong usage.\n.SH SEE "
         "ALSO\n" +
         seeAlso(command) + '\n';
}

namespace {

Result<Done> writePages(const Command& command, const std::filesystem::path& folder) {
  const auto written = writeAtomically((folder / (pageName(command.name) + ".1")).string(), manPage(command));
  if (!written) return written.findings();
  for (const Command& sub : command.commands)
    if (const auto done = writePages(sub, folder); !done) return done;
  return Done{};
}

}  // namespace

Result<Done> writeManual(const Command& program, const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return Finding{Severity::error, folder, "", "a folder that can be made", error.message()};
  if (const auto pages = writePages(program, folder); !pages) return pages;
  const auto written = writeAtomically((std::filesystem::path(folder) / (program.name + ".bash")).string(),
                                       bashCompletion(program));
  if (!written) return written.findings();
  return Done{};
}

}  // namespace trimtab::manual
