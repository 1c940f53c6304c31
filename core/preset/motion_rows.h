#pragma once

#include "rows.h"

/// Rows of head motion (document C).
namespace trimtab::table {

inline constexpr std::array kMotionRows{
    row<&TuningParameters::motion, &MotionParameters::control>(
        {.key = "motion.control",
         .label = "Head motion control",
         .help = "Coarser levels and blur while the line of sight turns fast. Without restoration nothing "
                 "raises the level of detail again; the blur then ends by its duration alone.",
         .source = "C: section 3, Figures 7 to 9"}),
    row<&TuningParameters::motion, &MotionParameters::frames>(
        {.key = "motion.frames",
         .label = "A frame is",
         .help = "Document C's optimizer receives vertices and frame rate: it counts images, and its "
                 "threshold divides by their average rate. Counting the host's states instead gives the "
                 "same decisions on every machine, but a slow host then needs longer to fill a stack.",
         .source = "C: section 3.2, Figure 3"}),
    row<&TuningParameters::motion, &MotionParameters::reference>(
        {.key = "motion.reference",
         .label = "Motion of",
         .help = "Document C names heading and pitch \"of the aircraft or the pilot\". The line of sight "
                 "turns with both, as the picture does; the head alone ignores what the aircraft does.",
         .source = "C: FOV movement"}),
    row<&TuningParameters::motion, &MotionParameters::leftFov>(
        {.key = "motion.left_fov_deg",
         .label = "Field of view, left",
         .help = "A frame is fast when it turns by more than the left and right fields of view together, "
                 "divided by the frames a second. They need not be those of the picture.",
         .source = "C: Eq. 1",
         .hard = {0, 180},
         .usual = {0, 90},
         .step = 1,
         .decimals = 1}),
    row<&TuningParameters::motion, &MotionParameters::rightFov>(
        {.key = "motion.right_fov_deg",
         .label = "Field of view, right",
         .help = "With the left one it makes the threshold of Eq. 1: one such field of view a second.",
         .source = "C: Eq. 1",
         .hard = {0, 180},
         .usual = {0, 90},
         .step = 1,
         .decimals = 1}),
    row<&TuningParameters::motion, &MotionParameters::dwell>(
        {.key = "motion.dwell",
         .label = "Dwell in",
         .help = "Whether a run of fast or slow frames is measured by their number, as published, or by "
                 "their time, which is the same at any frame rate.",
         .source = "C: BlurStack, LODRestoreStack"}),
    row<&TuningParameters::motion, &MotionParameters::blurFrames>(
        {.key = "motion.blur_frames",
         .label = "Fast frames",
         .help = "So many fast frames in a row lower the level of detail and start the blur.",
         .source = "C: BlurStack",
         .hard = {1, 1000},
         .usual = {1, 60},
         .step = 1,
         .whole = true}),
    row<&TuningParameters::motion, &MotionParameters::restoreFrames>(
        {.key = "motion.restore_frames",
         .label = "Slow frames",
         .help = "More than so many slow frames in a row raise the level of detail and stop the blur.",
         .source = "C: LODRestoreStack",
         .hard = {0, 1000},
         .usual = {0, 60},
         .step = 1,
         .whole = true}),
    row<&TuningParameters::motion, &MotionParameters::blurDwell>(
        {.key = "motion.blur_dwell_ms",
         .label = "Fast for",
         .help = "With the dwell in milliseconds: a run of fast frames that lasts so long lowers the level "
                 "of detail and starts the blur.",
         .hard = {0, 10000},
         .usual = {0, 1000},
         .step = 10}),
    row<&TuningParameters::motion, &MotionParameters::restoreDwell>(
        {.key = "motion.restore_dwell_ms",
         .label = "Slow for",
         .help = "With the dwell in milliseconds: a run of slow frames longer than this raises the level of "
                 "detail and stops the blur.",
         .hard = {0, 10000},
         .usual = {0, 1000},
         .step = 10}),
    row<&TuningParameters::motion, &MotionParameters::lodOverTime>(
        {.key = "motion.lod_over_ms",
         .label = "Coarser over",
         .help = "If frames are images: fast motion lowers the level of detail only while the average frame "
                 "takes longer than this; the blur starts anyway. 0 sets no such condition.",
         .source = "C: section 5, LOD scale according to FPS",
         .hard = {0, 1000},
         .usual = {0, 50},
         .step = 0.1,
         .decimals = 1}),
    row<&TuningParameters::motion, &MotionParameters::lodOverVertices>(
        {.key = "motion.lod_over_vertices",
         .label = "Coarser over vertices",
         .help = "If frames are images: fast motion lowers the level of detail only while the last image "
                 "had more vertices than this; the blur starts anyway. 0 sets no such condition.",
         .source = "C: section 3.2, Figure 3",
         .hard = {0, 1e9},
         .usual = {0, 1e6},
         .step = 1000,
         .whole = true}),
    row<&TuningParameters::motion, &MotionParameters::lodStep>(
        {.key = "motion.lod_step",
         .label = "LOD scale step",
         .help = "Distance between neighbouring levels: each step multiplies or divides the LOD scale by "
                 "this.",
         .source = "C: LOD level selector",
         .hard = {1.01, 16},
         .usual = {1.1, 4},
         .step = 0.1,
         .decimals = 2}),
    row<&TuningParameters::motion, &MotionParameters::lodMaximum>(
        {.key = "motion.lod_maximum",
         .label = "Largest LOD scale",
         .help = "Motion makes nothing coarser than this. With a step of 2, a maximum of 4 gives the three "
                 "levels of document C; with 1.2, 1.44 gives three that draw as many of the vertices as it "
                 "publishes.",
         .source = "C: LOD scale controller",
         .hard = {1, 100},
         .usual = {1, 16},
         .step = 0.5,
         .decimals = 2,
         .logarithmic = true}),
    row<&TuningParameters::motion, &MotionParameters::blurDuration>(
        {.key = "motion.blur_duration_ms",
         .label = "Blur duration",
         .help = "How long a blur lasts that nothing renews or stops. Shorter than a run of fast frames, it "
                 "flickers while the motion goes on.",
         .source = "C: blur scale controller",
         .hard = {0, 10000},
         .usual = {0, 2000},
         .step = 10}),
    row<&TuningParameters::motion, &MotionParameters::blurStrength>(
        {.key = "motion.blur_strength",
         .label = "Blur strength",
         .help = "Share of the picture before that is left after 1/60 s; at other frame rates the trail has "
                 "the same length. Without strength no blur pass is run.",
         .source = "C: blur scale controller",
         .hard = {0, 0.99},
         .usual = {0, 0.95},
         .step = 0.05,
         .decimals = 2}),
    row<&TuningParameters::motion, &MotionParameters::blurFullRate>(
        {.key = "motion.blur_full_degps",
         .label = "Full blur from",
         .help = "Document C blurs by the change of the line of sight and by its speed. A blur has its whole "
                 "strength where the run of fast frames that starts or renews it turns at this rate or "
                 "faster, and less in proportion where it turns slower. At 0 the strength does not follow "
                 "the speed.",
         .source = "C: section 3.2, Figure 4",
         .hard = {0, 10000},
         .usual = {0, 720},
         .step = 10}),
    row<&TuningParameters::motion, &MotionParameters::gap>(
        {.key = "motion.gap_ms",
         .label = "Gap",
         .help = "A longer step than this says nothing of the motion in it: both stacks are emptied.",
         .hard = {1, 60000},
         .usual = {20, 2000},
         .step = 10,
         .tier = Tier::advanced})};

}  // namespace trimtab::table
