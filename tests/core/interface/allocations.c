/* Counts what a frame allocates: allocations PRESET. It prints the count of 36,000 frames after the first 100. */
#include <math.h>
#include <stdio.h>
#include <trimtab/trimtab.h>

void* __libc_malloc(size_t);
void* __libc_calloc(size_t, size_t);
void* __libc_realloc(void*, size_t);

static unsigned long allocations;
void* malloc(size_t n) { return ++allocations, __libc_malloc(n); }
void* calloc(size_t n, size_t m) { return ++allocations, __libc_calloc(n, m); }
void* realloc(void* p, size_t n) { return ++allocations, __libc_realloc(p, n); }

int main(int argc, char** argv) {
  trimtab_preset* preset = NULL;
  trimtab_session* session = NULL;
  trimtab_state s = {.size = sizeof s};
  trimtab_frame frame = {.size = sizeof frame};
  trimtab_decision d = {.size = sizeof d};
  trimtab_step step;
  double lever;
  unsigned long before = 0;
  int i, wrong = 0;
  if (argc != 2 || trimtab_preset_load(argv[1], &preset, NULL) != TRIMTAB_OK ||
      trimtab_session_create(preset, &session) != TRIMTAB_OK || allocations == 0)
    return 1;
  trimtab_state_clear(&s);
  trimtab_frame_clear(&frame);
  s.latitude_deg = 27.8, s.longitude_deg = 86.7;
  for (i = 0; i < 36100; ++i) {
    if (i == 100) before = allocations;
    s.time_s = i / 60.0;
    s.height_m = 3000 + 2500 * sin(i / 500.0);
    s.longitude_deg += 2e-5;
    s.head_heading_deg = 60 * sin(i / 40.0), s.head_pitch_deg = 0, s.head_roll_deg = 0;
    wrong += trimtab_session_receive(session, &s, s.time_s, s.time_s) != TRIMTAB_OK;
    wrong += trimtab_session_request(session, s.time_s, 1280, 720, NULL) != TRIMTAB_OK;
    wrong += trimtab_session_lever(session, "lod_scale", &lever, &step) != TRIMTAB_OK;
    wrong += trimtab_session_decision(session, &d) != TRIMTAB_OK;
    frame.total_ms = 10 + i % 7, frame.triangles = 20000 + 1000 * (uint64_t)(i % 300);
    wrong += trimtab_session_finished(session, &frame, s.time_s) != TRIMTAB_OK;
  }
  printf("%lu\n", allocations - before);
  trimtab_session_free(session);
  trimtab_preset_free(preset);
  return wrong != 0;
}
