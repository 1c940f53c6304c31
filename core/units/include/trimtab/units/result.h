#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace trimtab {

enum class Severity { note, warning, error };

/// One thing that is wrong, or worth knowing, about data from outside: a preset, a packet, a terrain file.
struct Finding {
  Severity severity = Severity::error;
  std::string
      where;  ///< file, with line or byte offset where there is one: "a.json:12", "udp 127.0.0.1:5500 #14"
  std::string key;       ///< parameter key or field name; empty if it is about the whole file
  std::string expected;  ///< what would have been right, with its unit
  std::string found;     ///< what was there

  friend bool operator==(const Finding&, const Finding&) = default;
};

using Findings = std::vector<Finding>;

/// Reports whether at least one of the findings is an error.
bool hasError(const Findings& findings);

/// Returns "where: key: expected ..., found ..." on one line, for terminals and message boxes.
std::string toString(const Finding& finding);
std::string toString(const Findings& findings);

/// Holds a value, or all the reasons why there is none. A value may come with notes and warnings.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value, Findings notes = {}) : value_(std::move(value)), findings_(std::move(notes)) {}
  Result(Finding error) { findings_.push_back(std::move(error)); }
  Result(Findings errors) : findings_(std::move(errors)) {}

  explicit operator bool() const { return value_.has_value(); }
  bool ok() const { return value_.has_value(); }
  const T& value() const& { return value_.value(); }
  T& value() & { return value_.value(); }
  T&& value() && { return std::move(value_).value(); }
  const T* operator->() const { return &value_.value(); }
  T* operator->() { return &value_.value(); }
  const T& operator*() const { return value_.value(); }
  T& operator*() { return value_.value(); }
  const Findings& findings() const { return findings_; }

 private:
  std::optional<T> value_;
  Findings findings_;
};

/// The value of work that yields nothing but success.
struct Done {};

}  // namespace trimtab
