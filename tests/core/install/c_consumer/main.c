#include <stdio.h>
#include <trimtab/trimtab.h>

int main(int argc, char** argv) {
  trimtab_preset* preset = NULL;
  trimtab_session* session = NULL;
  trimtab_state state = {.size = sizeof state};
  char line[500];
  if (argc != 2 || trimtab_preset_load(argv[1], &preset, NULL) || trimtab_session_create(preset, &session)) return 1;
  trimtab_state_clear(&state);
  state.height_m = 5000 * 0.3048;
  trimtab_session_fly(session, &state);
  trimtab_session_explain(session, line, sizeof line);
  return puts(line) < 0;
}
