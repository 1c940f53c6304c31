#include "tests/cpp_outline.h"

#include <algorithm>
#include <cctype>
#include <initializer_list>
#include <string_view>

namespace trimtab::test {
namespace {

struct Token {
  std::string text;
  std::size_t line;
};

bool isWord(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
}

/// The end of the string or character literal at `at`; literals hold no declarations.
std::size_t literalEnd(const std::string& s, std::size_t at) {
  if (at > 0 && s[at] == '"' && s[at - 1] == 'R') {
    const std::size_t open = s.find('(', at);
    const std::string close = ")" + s.substr(at + 1, open - at - 1) + "\"";
    return std::min(s.size(), s.find(close, open) + close.size());
  }
  for (std::size_t i = at + 1; i < s.size(); ++i) {
    if (s[i] == '\\')
      ++i;
    else if (s[i] == s[at])
      return i + 1;
  }
  return s.size();
}

/// The end of the preprocessor line at `at`, with the lines that it continues on.
std::size_t directiveEnd(const std::string& s, std::size_t at) {
  while (at < s.size() && (s[at] != '\n' || s[at - 1] == '\\')) ++at;
  return at;
}

std::vector<Token> tokens(const std::string& s) {
  std::vector<Token> found;
  std::size_t line = 1;
  bool lineStart = true;
  for (std::size_t i = 0, end = 0; i < s.size(); i = end) {
    end = i + 1;
    if (s[i] == '#' && lineStart) {
      end = directiveEnd(s, i);
    } else if (s.compare(i, 2, "//") == 0) {
      end = std::min(s.size(), s.find('\n', i));
    } else if (s.compare(i, 2, "/*") == 0) {
      end = std::min(s.size(), s.find("*/", i + 2)) + 2;
    } else if (s[i] == '"' || s[i] == '\'') {
      end = literalEnd(s, i);
      found.push_back({"\"\"", line});
    } else if (isWord(s[i])) {
      // A quote between digits parts them and begins no literal.
      while (end < s.size() && (isWord(s[end]) || (s[end] == '\'' && std::isdigit(s[i])))) ++end;
      found.push_back({s.substr(i, end - i), line});
    } else if (!std::isspace(static_cast<unsigned char>(s[i]))) {
      for (const char* pair : {"::", "->", "<<", "&&", "<=", ">=", "=="})
        if (s.compare(i, 2, pair) == 0) end = i + 2;
      found.push_back({s.substr(i, end - i), line});
    }
    if (s[i] == '\n')
      lineStart = true;
    else if (!std::isspace(static_cast<unsigned char>(s[i])))
      lineStart = false;
    line += static_cast<std::size_t>(std::count(
        s.begin() + static_cast<long>(i), s.begin() + static_cast<long>(std::min(end, s.size())), '\n'));
  }
  return found;
}

bool isOneOf(const Token& token, std::initializer_list<std::string_view> words) {
  return std::find(words.begin(), words.end(), token.text) != words.end();
}

/// One declaration.
struct Statement {
  /// Its tokens outside of brackets of any kind, of a constructor's initializers and of what follows `=`.
  std::vector<Token> head;
  std::size_t arguments = 0;  ///< the most that a pair of its parentheses holds
  std::size_t commas = 0;     ///< between declarators
  bool isFunction = false;
  bool hasValue = false;         ///< there was a `=`
  bool hasInitializers = false;  ///< a constructor's, after its `:`

  bool has(std::initializer_list<std::string_view> words) const {
    return std::any_of(head.begin(), head.end(), [&](const Token& token) { return isOneOf(token, words); });
  }
  bool opensNamespace() const { return has({"namespace", "extern"}) && !isFunction && !hasValue; }
  bool opensClass() const {
    return has({"class", "struct", "union"}) && !has({"enum"}) && !isFunction && !hasValue;
  }
  bool isData() const {
    const bool onlyNamesAType = head.size() == 2 && isOneOf(head[0], {"class", "struct", "union"});
    return head.size() > 1 && !isFunction && !onlyNamesAType &&
           !has({"using", "friend", "typedef", "static", "static_assert", "template", "enum"});
  }
  std::string text() const {
    std::string words;
    for (const Token& token : head) words += (words.empty() ? "" : " ") + token.text;
    return words.substr(0, 100);
  }
};

class Reader {
 public:
  Reader(std::vector<Token> tokens, std::vector<Declared>& classes, std::vector<Declared>& functions)
      : tokens_(std::move(tokens)), classes_(classes), functions_(functions) {}

  bool atEnd() const { return at_ >= tokens_.size(); }

  /// Reads the declarations of a scope and the brace that closes it. Returns the number of data members.
  std::size_t scope() {
    std::size_t members = 0;
    while (at_ < tokens_.size() && !isNow("}")) {
      const Statement statement = declaration();
      if (statement.isFunction && !statement.head.empty())
        functions_.push_back({statement.text(), statement.head.front().line, statement.arguments});
      if (statement.isData()) members += 1 + statement.commas;
    }
    if (at_ < tokens_.size()) ++at_;
    return members;
  }

 private:
  bool isNow(std::string_view text) const { return tokens_[at_].text == text; }
  bool isBefore(std::initializer_list<std::string_view> words) const {
    return at_ > 0 && isOneOf(tokens_[at_ - 1], words);
  }
  bool isAfterWord() const { return at_ > 0 && isWord(tokens_[at_ - 1].text[0]); }

  /// Passes over the brackets that open here. Returns the number of what commas part in them.
  std::size_t skipBrackets() {
    std::size_t parts = 0, depth = 0, angles = 0;
    for (; at_ < tokens_.size(); ++at_) {
      if (isOneOf(tokens_[at_], {")", "]", "}"}) && --depth == 0) break;
      if (depth == 1 && parts == 0) parts = 1;
      if (depth == 1 && angles == 0 && isNow(",")) ++parts;
      if (depth == 1 && isNow("<") && isAfterWord()) ++angles;
      if (depth == 1 && isNow(">") && angles > 0) --angles;
      if (isOneOf(tokens_[at_], {"(", "[", "{"})) ++depth;
    }
    ++at_;
    return parts;
  }

  /// Passes over the angle brackets that open here.
  void skipAngles() {
    for (std::size_t depth = 0; at_ < tokens_.size() && !isNow(";");) {
      if (isOneOf(tokens_[at_], {"(", "[", "{"})) {
        skipBrackets();
        continue;
      }
      if (isNow("<")) ++depth;
      const bool closes = isNow(">") && --depth == 0;
      ++at_;
      if (closes) return;
    }
  }

  /// Reads the braces that open here. Returns true if the declaration ends with them.
  bool braces(Statement& statement) {
    if (statement.opensNamespace()) {
      ++at_;
      scope();
      statement = {};
      return true;
    }
    if (statement.opensClass()) {
      const Declared named{statement.text(), tokens_[at_].line, 0};
      ++at_;
      const std::size_t members = scope();
      classes_.push_back({named.name, named.line, members});
      statement = {{{"{}", named.line}}};  // a declarator may follow
      return false;
    }
    const bool isValue = statement.hasInitializers ? isAfterWord() || isBefore({">"})
                                                   : !statement.isFunction || statement.hasValue;
    skipBrackets();
    return !isValue;
  }

  void parentheses(Statement& statement) {
    const bool ofOperator = isBefore({"operator"}),
               ofSpecifier = isBefore({"alignas", "decltype", "noexcept"});
    const std::size_t parts = skipBrackets();
    if (ofOperator || ofSpecifier || statement.hasValue || statement.hasInitializers) return;
    statement.isFunction = true;
    statement.arguments = std::max(statement.arguments, parts);
  }

  Statement declaration() {
    Statement statement;
    while (at_ < tokens_.size() && !isNow("}")) {
      if (isNow("{")) {
        if (braces(statement)) return statement;
        continue;
      }
      if (isNow("(")) {
        parentheses(statement);
        continue;
      }
      if (isNow("[")) {
        skipBrackets();
        continue;
      }
      if (isNow("<") && isAfterWord() && !isBefore({"operator"})) {
        skipAngles();
        continue;
      }
      const Token& token = tokens_[at_];
      ++at_;
      if (token.text == ";") return statement;
      if (token.text == ":" && statement.isFunction)
        statement.hasInitializers = true;
      else if (token.text == ":" && statement.has({"public", "private", "protected", "signals"}) &&
               !statement.opensClass())
        statement = {};
      else if (token.text == "=" && !isOneOf(tokens_[at_ - 2], {"operator"}))
        statement.hasValue = true;
      else if (token.text == "," && !statement.hasInitializers)
        ++statement.commas;
      else if (!statement.hasValue && !statement.hasInitializers)
        statement.head.push_back(token);
    }
    return statement;
  }

  std::vector<Token> tokens_;
  std::size_t at_ = 0;
  std::vector<Declared>&classes_, &functions_;
};

}  // namespace

CppOutline::CppOutline(const std::string& source) {
  Reader reader(tokens(source), classes_, functions_);
  reader.scope();
  complete_ = reader.atEnd();
}

}  // namespace trimtab::test
