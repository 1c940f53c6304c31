// Light on ground of a normal, from the sky and from the sun: the shaders' version of sun.h.
uniform vec3 sun;  // unit vector towards it

float lightOn(vec3 normal) {
  return SKY_LIGHT + UPWARD_LIGHT * normal.z + SUN_LIGHT * max(dot(normalize(normal), sun), 0.0);
}
