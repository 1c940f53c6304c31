#ifndef TRIMTAB_TRIMTAB_H
#define TRIMTAB_TRIMTAB_H

/* The C interface of Trimtab (C99): what an image generator (IG) in any language needs to follow a preset.
 *
 *     load a preset -> make a session -> for each frame: give it states or datagrams, request the image, read the
 *     levers, draw, report what the frame took
 *
 * It holds no decision of its own: the session behind it is the one that the workbench and trimtab-ig use, and
 * decides the same to the bit. It opens no socket, starts no thread and has no clock: the caller passes times, in
 * seconds of CLOCK_REALTIME.
 *
 * Threads: a session belongs to one thread at a time. Presets and findings never change after they are made, and any
 * thread may read them. Calls with different handles may run at once.
 * Memory: functions marked "each frame" allocate nothing once the session has warmed up, unless the preset shows
 * symbols, holds a budget, a trace is written or a fit is flown.
 * Errors: no function ends the program or throws. A null handle or a null pointer where one is needed is
 * TRIMTAB_MISUSE, and TRIMTAB_FAILED is a lack of memory.
 * Structs: the caller sets `size` to sizeof the struct before every call. Later versions only append fields, so that a
 * program and a library of different age understand each other. Unknown numbers are NaN. Strings are UTF-8.
 */

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum trimtab_status {
  TRIMTAB_OK = 0,
  TRIMTAB_NOTHING = 1, /* nothing is wrong, but there is nothing yet: no state, or a datagram that holds none */
  TRIMTAB_REFUSED = 2, /* findings say why */
  TRIMTAB_MISUSE = 3,  /* a null pointer, an unknown key, or a `size` smaller than that of version 1 */
  TRIMTAB_FAILED = 4   /* out of memory */
} trimtab_status;

/* Who may change a lever, in this order. */
typedef enum trimtab_step {
  TRIMTAB_STEP_PRESET = 0,
  TRIMTAB_STEP_MOTION = 1,  /* head motion */
  TRIMTAB_STEP_WEATHER = 2,
  TRIMTAB_STEP_POLICY = 3,  /* fuzzy rules */
  TRIMTAB_STEP_BUDGET = 4   /* the last step: what is drawn */
} trimtab_step;

typedef struct trimtab_findings trimtab_findings;
typedef struct trimtab_preset trimtab_preset;
typedef struct trimtab_session trimtab_session;

/* Returns the version of the library, "0.2.0". */
const char* trimtab_version(void);

/* ---- Findings: what is wrong with a file, or worth knowing. */

typedef struct trimtab_finding {
  size_t size;
  int32_t severity;     /* 0 note, 1 warning, 2 error */
  int32_t reserved;     /* 0 */
  const char* where;    /* file, with line where there is one */
  const char* key;      /* parameter; empty if it is about the whole file */
  const char* expected; /* what would have been right, with its unit */
  const char* found;
} trimtab_finding;

size_t trimtab_findings_count(const trimtab_findings* findings); /* 0 for null */
/* Fills in finding `i`; its strings live as long as `findings`. */
trimtab_status trimtab_findings_get(const trimtab_findings* findings, size_t i, trimtab_finding* out);
void trimtab_findings_free(trimtab_findings* findings); /* null is allowed, as for every _free */

/* ---- Presets. */

/* Loads an export (JSON, XML or INI, told apart by content), an edited preset, or a shipped one by its name. An export
 * whose checksum does not hold is refused. `*findings` gets all findings, also of success (warnings), and is to be
 * freed; it may be null if nobody reads them. */
trimtab_status trimtab_preset_load(const char* name_or_file, trimtab_preset** preset, trimtab_findings** findings);
/* Does the same with a text; `where` names it in findings. */
trimtab_status trimtab_preset_parse(const char* text, size_t length, const char* where, trimtab_preset** preset,
                                    trimtab_findings** findings);
void trimtab_preset_free(trimtab_preset* preset);

/* ---- This image generator: what it has (a profile), and what a flight on it has taught (a fit). Files of
 * both are JSON; integrating.md says what is in them. */

typedef struct trimtab_profile trimtab_profile;
typedef struct trimtab_fit trimtab_fit;

trimtab_status trimtab_profile_load(const char* file, trimtab_profile** profile, trimtab_findings** findings);
void trimtab_profile_free(trimtab_profile* profile);

/* A lever as the image generator has it. Its values are in its own unit. */
typedef struct trimtab_own_lever {
  size_t size;
  const char* key;     /* Trimtab's: "lod_scale" */
  const char* own_key; /* the image generator's: "LODScale" */
  const char* own_unit;
  double from, to, neutral;
} trimtab_own_lever;

size_t trimtab_profile_lever_count(const trimtab_profile* profile); /* 0 for null */
/* Fills in lever `i`; its strings live as long as the profile. */
trimtab_status trimtab_profile_lever(const trimtab_profile* profile, size_t i, trimtab_own_lever* out);

trimtab_status trimtab_fit_load(const char* file, trimtab_fit** fit, trimtab_findings** findings);
void trimtab_fit_free(trimtab_fit* fit);

/* Makes another preset that decides nothing for which the profile's image generator has no lever and, if `fit` is not
 * null, whose terms lie over the load of this image generator. The findings are notes that name each change;
 * a fit of another image generator is refused. */
trimtab_status trimtab_preset_adapt(const trimtab_preset* preset, const trimtab_profile* profile,
                                    const trimtab_fit* fit, trimtab_preset** adapted,
                                    trimtab_findings** findings);

/* ---- Sessions. */

/* If the environment has TRIMTAB_PROFILE, the session begins with that file's profile; if it also has
 * TRIMTAB_FIT, it begins a fit to that file. So a program that draws the eye and the levers of its session is
 * fitted as it is. A file that cannot be used is TRIMTAB_REFUSED, and why is written to standard error. */
trimtab_status trimtab_session_create(const trimtab_preset* preset, trimtab_session** session);
void trimtab_session_free(trimtab_session* session); /* ends a trace, whose last findings are lost */
/* Sets an edited preset for the next state on. The memory stays, and so does the choice of protocol and aircraft. */
trimtab_status trimtab_session_set_preset(trimtab_session* session, const trimtab_preset* preset);
/* Forgets states, memory and host, for a new flight. */
trimtab_status trimtab_session_restart(trimtab_session* session);

/* Gives the session the levers of the image generator and what it reports of an image, and with a fit (may be null)
 * what images cost and by what their load falls, so that a budget holds from the second image on. Both are copied. A fit
 * of another image generator, or from too few views, is TRIMTAB_REFUSED. While a fit is flown, the profile that it is
 * flown with changes nothing, and another one is TRIMTAB_MISUSE. */
trimtab_status trimtab_session_set_profile(trimtab_session* session, const trimtab_profile* profile,
                                           const trimtab_fit* fit);

/* What a host says about the aircraft. trimtab_state_clear makes all optional parts unknown. */
typedef struct trimtab_state {
  size_t size;
  uint64_t packet; /* the host's frame number, or a running count */
  double time_s;   /* on the host's clock */
  double latitude_deg, longitude_deg, height_m;  /* WGS84 */
  double heading_deg, pitch_deg, roll_deg;       /* true; nose up, right wing down positive */
  double above_ground_m;                         /* optional, as all below */
  double head_heading_deg, head_pitch_deg, head_roll_deg; /* relative to the aircraft; all three or none */
  double airspeed_kt;
  double velocity_north_mps, velocity_east_mps, velocity_down_mps; /* over the ground; all three or none */
  double visibility_m;                                             /* of the whole atmosphere */
  double wind_mps, wind_from_deg, wind_up_mps;                     /* all three or none */
  int32_t precipitation;           /* -1 the host said nothing, 0 none, 1 rain, 2 snow */
  int32_t severity;                /* 0 to 5, of the precipitation */
  double precipitation_visibility_m;
  int32_t ground_clamp;            /* 0 none, 1 level, 2 conformal */
  int32_t has_view;                /* not 0: the host asks for the half-angles below; each may be NaN */
  double view_near_m, view_left_deg, view_right_deg, view_bottom_deg, view_top_deg;
} trimtab_state;

/* Makes everything but `size` zero or unknown. */
trimtab_status trimtab_state_clear(trimtab_state* state);

/* Each frame. Decides a row of a recorded flight: nothing is extrapolated. */
trimtab_status trimtab_session_fly(trimtab_session* session, const trimtab_state* state);
/* Each frame. Decides a state of a live host, which arrived at `arrival_s`. */
trimtab_status trimtab_session_receive(trimtab_session* session, const trimtab_state* state, double arrival_s,
                                       double now_s);
/* Decodes a datagram (CIGI 3 or 4, native-fdm, DIS, X-Plane; told apart by content, or as the preset says)
 * and decides its state. TRIMTAB_NOTHING if it leads to none; trimtab_session_explain_host says why. `from` names the
 * sender, "127.0.0.1:5500"; it is copied. */
trimtab_status trimtab_session_datagram(trimtab_session* session, const void* bytes, size_t length, const char* from,
                                        double arrival_s, double now_s);
/* Returns the state of the link: "never", "live", "silent" or "jumped". */
const char* trimtab_session_link(const trimtab_session* session, double now_s);

/* ---- Images. */

/* The eye and the perspective of an image. */
typedef struct trimtab_image {
  size_t size;
  double time_s; /* on the host's clock */
  double latitude_deg, longitude_deg, height_m;
  double heading_deg, pitch_deg, roll_deg; /* of the view: aircraft, or aircraft and head */
  int32_t width_px, height_px;
  double left, right, bottom, top; /* tangents of the half-angles; left and bottom are negative */
  double near_m;
} trimtab_image;

/* Returns 1 if an image at `now_s` would differ from the last one, else 0. */
int32_t trimtab_session_needs_image(const trimtab_session* session, double now_s);
/* Each frame. Requests the image of `now_s`: moves the eye on between states and runs the budget's step.
 * TRIMTAB_NOTHING before the first state. `image` may be null. */
trimtab_status trimtab_session_request(trimtab_session* session, double now_s, int32_t window_width_px,
                                       int32_t window_height_px, trimtab_image* image);

/* What one drawn image took. */
typedef struct trimtab_frame {
  size_t size;
  double total_ms, select_ms, occlusion_ms, cull_ms, draw_ms, gpu_ms; /* NaN: not measured */
  uint64_t triangles, vertices, nodes; /* drawn; 0 counts as an empty image for rules about triangles */
} trimtab_frame;

trimtab_status trimtab_frame_clear(trimtab_frame* frame);
/* Each frame. Reports the image that was requested last. */
trimtab_status trimtab_session_finished(trimtab_session* session, const trimtab_frame* frame, double now_s);
/* Call it while no image is drawn, as for a hidden window. */
trimtab_status trimtab_session_no_image(trimtab_session* session);

/* ---- Decisions. They are those of the newest image, or of the newest state if no image was requested after it. */

typedef struct trimtab_lever {
  size_t size;
  const char* key;   /* "lod_scale" */
  const char* label; /* "LOD scale" */
  const char* unit;  /* "px", "m" or empty */
} trimtab_lever;

/* The levers have fixed places in one run of the library; a later version appends some. */
size_t trimtab_lever_count(void);
trimtab_status trimtab_lever_get(size_t i, trimtab_lever* out);
/* Returns the place of a lever; trimtab_lever_count() if the key is unknown. */
size_t trimtab_lever_find(const char* key);

/* Each frame. Fills in the first `count` levers after a step, in the order of trimtab_lever_get. An unlimited distance
 * is infinite; the occlusion's resolution is its width. */
trimtab_status trimtab_session_levers(trimtab_session* session, trimtab_step step, double* values, size_t count);
/* Each frame. One lever as it is to be drawn, and the last step that changed it (may be null). */
trimtab_status trimtab_session_lever(trimtab_session* session, const char* key, double* value, trimtab_step* step);

/* Each frame. Fills in the first `count` levers of the session's profile, in its order, in the image
 * generator's own units and within its ranges. Without a screen_space_error of its own, its lod_scale takes
 * that factor too. TRIMTAB_MISUSE without a profile. */
trimtab_status trimtab_session_own_levers(trimtab_session* session, double* values, size_t count);

/* What a decision says beside the levers. Strings are names that never go away. */
typedef struct trimtab_decision {
  size_t size;
  const char* scheme; /* "frustum", or "dynamic": look for hidden ground too */
  const char* scheme_reason;
  const char* motion_reason;
  const char* weather_reason;
  const char* far_reason;
  const char* budget_reason;
  const char* precipitation; /* "none", "rain", "snow" */
  int32_t band;              /* -1: below all of them */
  int32_t fogged;
  int32_t occlusion_width_px, occlusion_height_px; /* 0: no test for hidden ground */
  double altitude_ft, total_membership;
  double blur_remaining_ms;
  double precipitation_density; /* 0 to 1 */
  double extinction_per_m, visibility_m, layer_top_m, near_far_ratio;
} trimtab_decision;

/* Each frame. */
trimtab_status trimtab_session_decision(trimtab_session* session, trimtab_decision* out);

/* These write one line for people, cut to `capacity` with its zero, and return its length; they allocate. An unknown
 * key or a null handle gives an empty line. */
size_t trimtab_session_explain(trimtab_session* session, char* text, size_t capacity);
/* "preset 2 px, policy 4 px, budget 5.66 px": who set a lever, in order. */
size_t trimtab_session_explain_lever(trimtab_session* session, const char* key, char* text, size_t capacity);
/* Why the newest datagram led to no state; empty if it did. */
size_t trimtab_session_explain_host(const trimtab_session* session, char* text, size_t capacity);

/* ---- Traces: a row per decision, which the workbench and trimtab-cli replay to the bit. */

/* Begins a trace; it appears under its name when it is finished, until then it is FILE.part. */
trimtab_status trimtab_session_trace_start(trimtab_session* session, const char* file, trimtab_findings** findings);
trimtab_status trimtab_session_trace_finish(trimtab_session* session, trimtab_findings** findings);

/* ---- Fits: the session draws each view of a flight with every lever neutral, and once for each setting of
 * each lever. The program's loop stays as it is, if it draws the eye of trimtab_image: the session requests
 * the same view again until it has all settings of it, whatever states arrive meanwhile. A view takes some
 * twenty images, a fit at least twenty views. No trace rows are made. */

/* Begins a fit; the session needs a profile. What is known is written to `file` every few views. With images, the last
 * one of a view is compared in trimtab_session_finished, which then takes some tenths of a second. */
trimtab_status trimtab_session_fit_start(trimtab_session* session, const char* file,
                                         trimtab_findings** findings);
/* Returns how many views are complete; 0 without a fit. */
size_t trimtab_session_fit_views(const trimtab_session* session);
/* Returns 1 if the image that was requested last counts, so that its pixels are worth reading; else 0. */
int32_t trimtab_session_fit_wants_picture(const trimtab_session* session);
/* Gives the image that was drawn, RGBA of one byte each in rows without gaps, before
 * trimtab_session_finished. Then the fit also says what each lever costs the image, and how many pixels the
 * neutral level of detail stands for. The bytes are copied, where they count. */
trimtab_status trimtab_session_fit_picture(trimtab_session* session, const void* rgba, int32_t width_px,
                                           int32_t height_px);
/* Ends the fit and writes its file. Too few views, or no times, are refused. Freeing the session does so too.
 */
trimtab_status trimtab_session_fit_finish(trimtab_session* session, trimtab_findings** findings);

#ifdef __cplusplus
}
#endif

#endif
