#pragma once

#include <string>
#include <vector>

/// What a source file declares, as far as the limits of the house need it.
namespace trimtab::test {

/// One class or function, with a number: a class's data members, or a function's arguments.
struct Declared {
  std::string name;
  std::size_t line = 0;
  std::size_t count = 0;
};

/// Reads declarations in namespaces and classes; bodies of functions are skipped. It is a reader of text, not
/// a compiler: macros are not expanded, and both branches of an `#if` are read.
class CppOutline {
 public:
  explicit CppOutline(const std::string& source);

  /// Each class, struct and union with the number of its own data members that are not static.
  const std::vector<Declared>& classes() const { return classes_; }
  /// Each declaration and definition of a function, with the number of its arguments.
  const std::vector<Declared>& functions() const { return functions_; }

  /// False if the braces did not match, so that a part was not read.
  bool complete() const { return complete_; }

 private:
  std::vector<Declared> classes_, functions_;
  bool complete_ = false;
};

}  // namespace trimtab::test
