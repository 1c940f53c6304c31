// The functions of flip_lanes.inl on one number, for simd_levels.inl. The number stands in every lane of both vectors.

#include "core/measure/flip_lanes.inl"

struct Functions {
  float (*cubeRoot)(float), (*log2)(float), (*exp2)(float), (*reciprocal)(float);
};

float cubeRootAt(float x) {
  return cubeRoot(x).a[0];
}
float log2At(float x) {
  return log2Of(x).b[kWide - 1];
}
float exp2At(float x) {
  return exp2Of(x).a[1];
}
float reciprocalAt(float x) {
  return reciprocal(all(x))[0];
}

constexpr Functions functions{cubeRootAt, log2At, exp2At, reciprocalAt};
