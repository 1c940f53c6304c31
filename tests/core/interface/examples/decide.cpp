// Does what decide.c does, in C++: handles free themselves.
#include <trimtab/trimtab.h>

#include <cstdio>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

int main(int argc, char** argv) {
  if (argc != 3) return std::fputs("usage: decide PRESET TABLE\n", stderr), 2;
  trimtab_preset* loaded = nullptr;
  if (trimtab_preset_load(argv[1], &loaded, nullptr) != TRIMTAB_OK) return 1;
  const std::unique_ptr<trimtab_preset, void (*)(trimtab_preset*)> preset(loaded, trimtab_preset_free);
  trimtab_session* made = nullptr;
  if (trimtab_session_create(preset.get(), &made) != TRIMTAB_OK) return 1;
  const std::unique_ptr<trimtab_session, void (*)(trimtab_session*)> session(made, trimtab_session_free);

  trimtab_state s{};
  s.size = sizeof s;
  trimtab_state_clear(&s);
  trimtab_frame frame{};
  frame.size = sizeof frame;
  trimtab_frame_clear(&frame);
  trimtab_decision d{};
  d.size = sizeof d;
  std::vector<double> levers(trimtab_lever_count());
  std::ifstream table(argv[2]);
  for (std::string word; table >> word;) {  // as words, because a stream reads no "nan"
    std::vector<double> row{std::stod(word)};
    while (row.size() < 10 && table >> word) row.push_back(std::stod(word));
    if (row.size() < 10) return 1;
    s.time_s = row[0], s.latitude_deg = row[1], s.longitude_deg = row[2], s.height_m = row[3];
    s.heading_deg = row[4], s.pitch_deg = row[5], s.roll_deg = row[6];
    s.head_heading_deg = row[7], s.head_pitch_deg = row[8], s.head_roll_deg = row[9];
    trimtab_session_fly(session.get(), &s);
    trimtab_session_request(session.get(), s.time_s, 1280, 720, nullptr);
    trimtab_session_levers(session.get(), TRIMTAB_STEP_BUDGET, levers.data(), levers.size());
    trimtab_session_decision(session.get(), &d);
    for (const double lever : levers) std::printf("%.17g ", lever);
    std::printf("%s %s %s\n", d.scheme, d.scheme_reason, d.motion_reason);
    frame.triangles = 20000 + 1000 * (++s.packet % 300);
    trimtab_session_finished(session.get(), &frame, s.time_s);
  }
}
