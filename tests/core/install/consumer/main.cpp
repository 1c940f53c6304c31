#include <trimtab/decision/decide.h>
#include <trimtab/preset/preset.h>

#include <cstdio>

int main(int, char** argv) {
  const auto preset = trimtab::loadPreset(argv[1]);
  if (!preset) return std::puts(toString(preset.findings()).c_str()), 1;
  const auto parameters = trimtab::validate(preset->parameters);
  if (!parameters) return std::puts(toString(parameters.findings()).c_str()), 1;
  trimtab::FrameInput input;
  input.state.position.height = trimtab::Feet{5000}.as<trimtab::Metres>();
  trimtab::DecisionMemory memory;
  return std::puts(explain(decide(input, *parameters, memory), *parameters).c_str()) < 0;
}
