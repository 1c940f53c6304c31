#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <map>
#include <string>

#include "faults.h"
#include "tests/support.h"
#include "trimtab/units/result.h"

/// Every call on a file fails once in every way, and the process is killed after each. The promise: there is
/// the old state or the new one, a failure says why, and the next run leaves the new state and nothing else.
namespace trimtab::test {

using faults::Way;
/// The names below a folder, with what the files hold.
using Tree = std::map<std::string, std::string>;

struct WriteCase {
  /// Makes the old state in a folder; then the work, which is to lead to the new state and returns why it did
  /// not.
  std::function<void(const std::filesystem::path&)> begin;
  std::function<Findings(const std::filesystem::path&)> work;
  /// What may be there after a disturbed run beside the old state or the new one: work in hand.
  std::function<bool(const std::string&)> mayStay;
  /// Every so many points is tried; 1 with TRIMTAB_INJECTION=all.
  long stride = 1;
  /// What a person does before the next run if a message asks for it; returns what was wrong with what
  /// stayed.
  std::function<std::string(const std::filesystem::path&)> between = {};
  /// The work makes several files, one after the other, and goes on where it was stopped: each of them is the
  /// old one or the new one.
  bool inSteps = false;
  /// The file system has files without a name. Without them a mark is empty for a moment, and stays when the
  /// program is killed in it.
  bool unnamed = true;
};

struct ReadCase {
  std::function<void(const std::filesystem::path&)> begin;
  /// Reads all that is there: everything that it found as text, or why it could not.
  std::function<Result<std::string>(const std::filesystem::path&)> read;
  long stride = 1;
};

class Injection : public ::testing::Test {
 protected:
  void writes(const char* name, WriteCase of);
  /// Each call of a reader fails once. The promise: it finds the same, or it says why not; and a call that
  /// was interrupted or gave half is no reason to refuse.
  void reads(const char* name, ReadCase of);
};

}  // namespace trimtab::test
