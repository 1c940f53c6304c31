/* Flies a table of states and prints the levers of each: decide PRESET TABLE
 * A line of the table has time, latitude, longitude, height in metres, heading, pitch, roll, head's heading, pitch and
 * roll; nan is unknown. */
#include <stdio.h>
#include <trimtab/trimtab.h>

#define LEVERS 64

int main(int argc, char** argv) {
  trimtab_preset* preset = NULL;
  trimtab_findings* findings = NULL;
  trimtab_session* session = NULL;
  trimtab_state s = {.size = sizeof s};
  trimtab_decision d = {.size = sizeof d};
  trimtab_frame frame = {.size = sizeof frame};
  double levers[LEVERS];
  size_t i, count = trimtab_lever_count() < LEVERS ? trimtab_lever_count() : LEVERS;
  FILE* table;

  if (argc != 3) return fputs("usage: decide PRESET TABLE\n", stderr), 2;
  trimtab_status loaded = trimtab_preset_load(argv[1], &preset, &findings);
  for (i = 0; i < trimtab_findings_count(findings); ++i) {
    trimtab_finding f = {.size = sizeof f};
    trimtab_findings_get(findings, i, &f);
    fprintf(stderr, "%s: %s: expected %s, found %s\n", f.where, f.key, f.expected, f.found);
  }
  trimtab_findings_free(findings);
  if (loaded != TRIMTAB_OK || trimtab_session_create(preset, &session) != TRIMTAB_OK) return 1;
  table = fopen(argv[2], "r");
  if (table == NULL) return perror(argv[2]), 1;

  trimtab_state_clear(&s);
  trimtab_frame_clear(&frame);
  while (fscanf(table, "%lf %lf %lf %lf %lf %lf %lf %lf %lf %lf", &s.time_s, &s.latitude_deg, &s.longitude_deg,
                &s.height_m, &s.heading_deg, &s.pitch_deg, &s.roll_deg, &s.head_heading_deg, &s.head_pitch_deg,
                &s.head_roll_deg) == 10) {
    trimtab_session_fly(session, &s);
    trimtab_session_request(session, s.time_s, 1280, 720, NULL);
    trimtab_session_levers(session, TRIMTAB_STEP_BUDGET, levers, count);
    trimtab_session_decision(session, &d);
    for (i = 0; i < count; ++i) printf("%.17g ", levers[i]);
    printf("%s %s %s\n", d.scheme, d.scheme_reason, d.motion_reason);
    frame.triangles = 20000 + 1000 * (++s.packet % 300); /* an image generator draws, and says what it drew */
    trimtab_session_finished(session, &frame, s.time_s);
  }
  fclose(table);
  trimtab_session_free(session);
  trimtab_preset_free(preset);
  return 0;
}
