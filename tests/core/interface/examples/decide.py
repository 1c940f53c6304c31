"""Does what decide.c does, by ctypes: decide.py LIBRARY PRESET TABLE"""
import ctypes as c
import sys


def struct(name, **fields):
    """A struct of trimtab.h, whose `size` is set."""
    made = type(name, (c.Structure,), {"_fields_": [("size", c.c_size_t)] + list(fields.items())})
    return made(c.sizeof(made))


def doubles(names):
    return {name: c.c_double for name in names.split()}


library, preset_file, table = sys.argv[1:]
t = c.CDLL(library)
t.trimtab_lever_count.restype = c.c_size_t
state = struct(
    "State", packet=c.c_uint64,
    **doubles("time_s latitude_deg longitude_deg height_m heading_deg pitch_deg roll_deg above_ground_m head_heading_deg "
              "head_pitch_deg head_roll_deg airspeed_kt velocity_north_mps velocity_east_mps velocity_down_mps "
              "visibility_m wind_mps wind_from_deg wind_up_mps"),
    precipitation=c.c_int32, severity=c.c_int32, precipitation_visibility_m=c.c_double, ground_clamp=c.c_int32,
    has_view=c.c_int32, **doubles("view_near_m view_left_deg view_right_deg view_bottom_deg view_top_deg"))
frame = struct("Frame", **doubles("total_ms select_ms occlusion_ms cull_ms draw_ms gpu_ms"), triangles=c.c_uint64,
               vertices=c.c_uint64, nodes=c.c_uint64)
decision = struct(
    "Decision", **{name: c.c_char_p for name in ("scheme scheme_reason motion_reason weather_reason far_reason "
                                                 "budget_reason precipitation").split()},
    band=c.c_int32, fogged=c.c_int32, occlusion_width_px=c.c_int32, occlusion_height_px=c.c_int32,
    **doubles("altitude_ft total_membership blur_remaining_ms precipitation_density extinction_per_m visibility_m "
              "layer_top_m near_far_ratio"))

preset, session = c.c_void_p(), c.c_void_p()
if t.trimtab_preset_load(preset_file.encode(), c.byref(preset), None) != 0:
    sys.exit(preset_file + " is refused")
t.trimtab_session_create(preset, c.byref(session))
t.trimtab_state_clear(c.byref(state))
t.trimtab_frame_clear(c.byref(frame))
levers = (c.c_double * t.trimtab_lever_count())()
for line in open(table):
    (state.time_s, state.latitude_deg, state.longitude_deg, state.height_m, state.heading_deg, state.pitch_deg,
     state.roll_deg, state.head_heading_deg, state.head_pitch_deg, state.head_roll_deg) = map(float, line.split())
    t.trimtab_session_fly(session, c.byref(state))
    t.trimtab_session_request(session, c.c_double(state.time_s), 1280, 720, None)
    t.trimtab_session_levers(session, 4, levers, c.c_size_t(len(levers)))
    t.trimtab_session_decision(session, c.byref(decision))
    print(*("%.17g" % lever for lever in levers), decision.scheme.decode(), decision.scheme_reason.decode(),
          decision.motion_reason.decode())
    state.packet += 1
    frame.triangles = 20000 + 1000 * (state.packet % 300)
    t.trimtab_session_finished(session, c.byref(frame), c.c_double(state.time_s))
t.trimtab_session_free(session)
t.trimtab_preset_free(preset)
