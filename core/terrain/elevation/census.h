#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "evidence.h"
#include "values.h"

namespace trimtab::terrain {

/// Statistics of all numbers of a file, from which its voids are recognised and its content is judged.
///
/// A number means a void if it is a spike of the histogram, far from every other height in value and so in
/// space: one of kVoidNumbers, or the lowest or highest of all with a gap to the next that no ground has. A
/// number that the band's tag names is a void without further question. Depths are kept as far down as most
/// posts continue their neighbours.
class Census {
 public:
  /// Adds whole rows of `columns` numbers.
  void add(std::span<const float> raw, std::size_t columns, const Values& values);
  /// Counts the posts of a block that the file does not store; it reads as the no-data value, or as 0.
  void leaveOut(std::uint64_t count, const Values& values) {
    posts_ += count, tagged_ += values.noData ? count : 0;
  }
  /// Says which numbers are voids in the file.
  void judge(Values& values);

  /// Heights, and voids that have no tag, as `judge` said.
  std::uint64_t heights() const { return posts_ - tagged_ - untagged_; }
  std::uint64_t untagged() const { return untagged_; }
  /// Lists the voids without a tag by their numbers, for a note.
  const std::string& untaggedByNumber() const { return told_; }
  /// Says that most numbers can be no heights, and why that may be; empty if that is not so.
  std::optional<std::string> impossible() const;
  HeightShape shape(const Values& values) const;

 private:
  static constexpr std::size_t kBins = 420;  ///< of 50 m, all heights that are possible
  static constexpr std::size_t kEnds = 8;
  struct Number {
    std::uint64_t posts = 0, like = 0;  ///< like: other possible heights within a tenth, or beyond
  };
  /// The `kEnds` lowest, or highest, different numbers and how many posts have them.
  using End = std::map<float, std::uint64_t>;

  void addHeight(float raw, float metres);
  void addImpossible(float raw, const Values& values);
  void addDepths(std::span<const float> raw, std::size_t columns, const Values& values);
  void addSteps(std::span<const float> raw, std::size_t columns, const Values& values);
  bool isListedVoid(std::size_t number, const Values& values) const;
  /// Metres from `metres` to where 99 % of the heights are.
  double gapToBulk(double metres) const;
  void judgeEnds(Values& values, std::vector<std::pair<float, std::uint64_t>>& voids);
  void judgeDepths(Values& values, std::vector<std::pair<float, std::uint64_t>>& voids);

  std::uint64_t posts_ = 0, tagged_ = 0, untagged_ = 0;
  std::array<Number, kVoidNumbers.size()> numbers_{};
  std::array<std::uint64_t, kBins> bins_{}, calm_{};  ///< calm: posts of a depth that continue a neighbour
  End low_, high_;
  std::uint64_t heights_ = 0;  ///< possible ones, before judgement
  double sum_ = 0, squares_ = 0, origin_ = 0;
  std::uint64_t steps_ = 0, turns_ = 0;
  double stepSum_ = 0;
  std::map<float, std::uint64_t> strange_;  ///< impossible numbers, the first some
  std::uint64_t impossible_ = 0, absurd_ = 0, swappable_ = 0;
  std::string told_;
};

}  // namespace trimtab::terrain
