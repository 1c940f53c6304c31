#include <algorithm>

#include "app/manual/command.h"

namespace trimtab::manual {
namespace {

/// The lines of the two `case` statements, for a command and all below it. `path` is its name without the
/// program's, such as " terrain bake".
struct Cases {
  std::string commands;  ///< patterns of the subcommands
  std::string words;     ///< by command: what may stand where an option or a subcommand may
  std::string values;    ///< by command and option: what the option takes

  void add(const Command& command, const std::string& path) {
    std::string all;
    for (const Command& sub : command.commands) all += sub.name.substr(sub.name.rfind(' ') + 1) + ' ';
    for (const Argument& a : command.arguments) {
      if (a.positional()) continue;
      std::string pattern;
      for (const std::string& name : a.names) {
        all += name + ' ';
        pattern += (pattern.empty() ? "" : "|") + ("\"" + path + ' ' + name + '"');
      }
      if (a.value.empty()) continue;
      std::string choices;
      for (const std::string& choice : a.choices) choices += (choices.empty() ? "" : " ") + choice;
      values += "    " + pattern + ") words=\"" + choices + "\" ;;\n";
    }
    words += "    \"" + path + "\") words=\"" + all.substr(0, all.size() - 1) + "\" ;;\n";
    for (const Command& sub : command.commands) {
      const std::string below = path + sub.name.substr(sub.name.rfind(' '));
      commands += (commands.empty() ? "" : "|") + ('"' + below + '"');
      add(sub, below);
    }
  }
};

}  // namespace

std::string bashCompletion(const Command& program) {
  Cases cases;
  cases.add(program, "");
  std::string function = "_" + program.name;
  std::replace(function.begin(), function.end(), '-', '_');
  std::string out = "# Completion of " + program.name +
                    " for bash, written from the program's table of options.\n" + function +
                    "() {\n  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} "
                    "command= words= i\n";
  if (!cases.commands.empty())
    out += "  for ((i = 1; i < COMP_CWORD; ++i)); do\n    case \"$command ${COMP_WORDS[i]}\" in\n      " +
           cases.commands + ") command+=\" ${COMP_WORDS[i]}\" ;;\n    esac\n  done\n";
  out += "  case \"$command\" in\n" + cases.words + "  esac\n";
  // Without words bash offers files, which is right for every other value and for what is no option.
  out += "  [[ $word == -* || $words != -* ]] || words=\n";
  out += "  case \"$command $before\" in\n" + cases.values + "  esac\n";
  return out + "  COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n}\ncomplete -o default -F " + function +
         ' ' + program.name + '\n';
}

}  // namespace trimtab::manual
