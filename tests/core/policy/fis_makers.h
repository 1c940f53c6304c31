#pragma once

#include <random>
#include <string>

/// Makes MATLAB's files as people write them: a table of rules over two or three inputs.
namespace trimtab::test {

enum class FisKind { mamdani, planes, constants };

/// Returns a file whose inputs are "In1 (x)", "In2 (x)" ... over 0..10, 0..20 ..., and whose output is "Out"
/// over 0..100. Its rules say how the output rises or falls with the inputs, with some noise.
std::string randomFis(FisKind kind, std::size_t inputs, std::mt19937_64& random);

}  // namespace trimtab::test
