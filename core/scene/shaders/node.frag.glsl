#version 430 compatibility
// Writes which node a pixel shows. Where the weather's far cut discards a fragment, no node is written.
#pragma import_defines(IN_WEATHER, AIR_CUT)
#include "air.glsl"
in vec3 relative;          // metres from the eye
flat in uint owner;
out uint node;
void main() {
  throughAir(vec3(0.0), 1.0, relative);
  node = owner;
}
