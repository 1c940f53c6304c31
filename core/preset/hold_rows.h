#pragma once

#include "rows.h"

/// Rows of the arbiter that holds the frame's budget.
namespace trimtab::table {

inline constexpr std::array kHoldRows{
    row<&TuningParameters::hold, &HoldParameters::enabled>(
        {.key = "hold.enabled",
         .label = "Hold the budget",
         .help = "Predicts the time of each image before it is drawn, and lowers levers by the least loss "
                 "that fits measure.budget_ms. What the policy or the preset asks for comes back when there "
                 "is head-room."}),
    row<&TuningParameters::hold, &HoldParameters::margin>(
        {.key = "hold.margin",
         .label = "Margin",
         .help = "The share of the budget that predictions leave free, for what no prediction sees. Where "
                 "the model "
                 "is uncertain they leave more.",
         .hard = {0, 0.9},
         .usual = {0, 0.3},
         .step = 0.01,
         .decimals = 2}),
    row<&TuningParameters::hold, &HoldParameters::caution>(
        {.key = "hold.caution",
         .label = "Caution",
         .help = "An image that takes longer than predicted by so many of the model's 90 % bands still ends "
                 "within 1.1 of the budget. 1.41 lets one image in a hundred end later. 0 holds the median "
                 "image to the budget.",
         .hard = {0, 5},
         .usual = {0, 2},
         .step = 0.05,
         .decimals = 2}),
    row<&TuningParameters::hold, &HoldParameters::calm>(
        {.key = "hold.calm_ms",
         .label = "Calm before restoring",
         .help = "Levers are restored after a finer setting has been predicted to fit for so long without "
                 "interruption. Lowering never waits.",
         .hard = {0, 10000},
         .usual = {0, 1000},
         .step = 10,
         .decimals = 0}),
    row<&TuningParameters::hold, &HoldParameters::lookAhead>(
        {.key = "hold.look_ahead_frames",
         .label = "Look ahead",
         .help = "The triangles of the views of so many coming images are counted, as eye and head move "
                 "now. 0 counts the image that is about to be drawn alone.",
         .hard = {0, 30},
         .usual = {0, 10},
         .step = 1,
         .decimals = 0}),
    row<&TuningParameters::hold, &HoldParameters::errorMaximum>(
        {.key = "hold.error_maximum_px",
         .label = "Largest allowed error",
         .help = "The arbiter allows no larger screen-space error. Where the preset or the policy asks for "
                 "more, that stays.",
         .hard = {0.1, 64},
         .usual = {1, 32},
         .step = 0.5,
         .decimals = 1}),
    row<&TuningParameters::hold, &HoldParameters::renderScaleMinimum>(
        {.key = "hold.render_scale_minimum",
         .label = "Smallest render scale",
         .help = "The arbiter draws the scene at no smaller part of the image's width and height. 1 keeps "
                 "every pixel.",
         .hard = {0.25, 1},
         .usual = {0.5, 1},
         .step = 0.05,
         .decimals = 2}),
    row<&TuningParameters::hold, &HoldParameters::particlesMinimum>(
        {.key = "hold.particles_minimum",
         .label = "Smallest particle share",
         .help = "The arbiter keeps at least this share of the drops and flakes.",
         .hard = {0, 1},
         .usual = {0, 1},
         .step = 0.05,
         .decimals = 2}),
    row<&TuningParameters::hold, &HoldParameters::blurMinimum>(
        {.key = "hold.blur_minimum",
         .label = "Smallest blur strength",
         .help = "The arbiter keeps at least this share of the blur of head motion. 0 lets it leave the "
                 "blur out.",
         .hard = {0, 1},
         .usual = {0, 1},
         .step = 0.05,
         .decimals = 2}),
    row<&TuningParameters::hold, &HoldParameters::lossError>(
        {.key = "hold.loss_error",
         .label = "Loss of error",
         .help = "The mean FLIP lost from 1 to 16 px of allowed error, as leverage measures it over the "
                 "terrain in use. The arbiter gives up first what loses least for the time it wins.",
         .hard = {0, 1},
         .usual = {0, 0.2},
         .step = 0.001,
         .decimals = 4}),
    row<&TuningParameters::hold, &HoldParameters::lossRenderScale>(
        {.key = "hold.loss_render_scale",
         .label = "Loss of render scale",
         .help = "The mean FLIP lost from render scale 1 to 0.5.",
         .hard = {0, 1},
         .usual = {0, 0.2},
         .step = 0.001,
         .decimals = 4}),
    row<&TuningParameters::hold, &HoldParameters::lossParticles>(
        {.key = "hold.loss_particles",
         .label = "Loss of particles",
         .help = "The mean FLIP lost from all drops and flakes to none.",
         .hard = {0, 1},
         .usual = {0, 0.2},
         .step = 0.001,
         .decimals = 4}),
    row<&TuningParameters::hold, &HoldParameters::lossBlur>(
        {.key = "hold.loss_blur",
         .label = "Loss of blur",
         .help = "The mean FLIP lost without the blur. Measured against a sharp image it is 0: the blur is "
                 "itself an error there.",
         .hard = {0, 1},
         .usual = {0, 0.2},
         .step = 0.001,
         .decimals = 4})};

}  // namespace trimtab::table
