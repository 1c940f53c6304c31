#pragma once

#include "trimtab/frame/frame.h"

/// Triangles that GL does not cut, so that it judges all of them alike.
///
/// A rasteriser rounds corners to parts of a pixel. llvmpipe (Mesa's lp_setup_tri.c) says by rounded corners
/// which way a triangle faces; but where one vertex of a batch lies outside the view, the batch is cut, and
/// there (draw_pipe_cull.c) unrounded corners say it first. A sliver on a ridge that rounding turns to the
/// front is dropped then, its neighbours, which are rounded, do not close the gap, and the picture shows what
/// lies behind the mountain: one pixel in 13,500 views. So the view that GL knows is some times wider than
/// the picture, and what still reaches beyond it (a few nodes beside the eye, or behind it) is drawn from
/// both sides. Over Everest that costs 0.001 of the frame; both sides of all nodes at the picture's own edges
/// cost 0.16, of all nodes 0.56.
///
/// Why judging by rounded corners opens no gap. Slide each corner from its place to the rounded one. At a
/// pixel's middle that the surface's rim does not pass, the number of fronts less that of backs stays what it
/// was: 1 where the ray ends in the ground, 0 where it passes above it; for the mountain alone too. So the
/// mountain covers with its fronts what it covered, and a back has a front of its mountain beside it. Which
/// of the two is nearer is another matter: at a ridge both lie within a hair, and interpolated depths are
/// rounded. Drawn from both sides, one pixel in six views of Everest has the colour of the ridge's back, nine
/// in ten of them off by at most two of 255. Drivers that judge by unrounded corners everywhere (culling in a
/// shader before the rasteriser does) may lose slivers still.
namespace trimtab::scene {

/// What a context's viewports may be.
struct ViewportLimits {
  int widthPx = 0, heightPx = 0;  ///< at most
  bool beginAtHalves = false;     ///< of pixels
};
/// Of the current one.
ViewportLimits viewportLimitsOfContext();

/// How many times wider and higher than the picture: a power of two, so that no vertex moves by its rounding,
/// or 1 where viewports are too small, or begin at whole pixels alone and the picture's size is odd.
int guardBandOf(const ViewShape& view, const ViewportLimits& limits);

/// What GL does not cut, `times` as wide and high about the picture's middle.
ViewShape withGuardBand(const ViewShape& view, int times);

/// The viewport for it, while it lives; afterwards the picture's. The framebuffer ends where the picture
/// does.
class WideViewport {
 public:
  WideViewport(const ViewShape& view, int times);
  ~WideViewport();
  WideViewport(const WideViewport&) = delete;
  WideViewport& operator=(const WideViewport&) = delete;

 private:
  int widthPx_, heightPx_;
};

}  // namespace trimtab::scene
