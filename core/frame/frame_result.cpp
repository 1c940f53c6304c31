#include "trimtab/frame/frame_result.h"

namespace trimtab {

FrameCounters& FrameCounters::operator+=(const FrameCounters& other) {
  for (const auto counter :
       {&FrameCounters::precipitationPasses, &FrameCounters::blurPasses, &FrameCounters::symbologyDraws,
        &FrameCounters::particlesDrawn, &FrameCounters::symbologyRedraws, &FrameCounters::hostSymbolsLeftOut,
        &FrameCounters::cutsSelected, &FrameCounters::visibleSelected, &FrameCounters::tilesBuilt,
        &FrameCounters::tilesBuiltAhead, &FrameCounters::depthMapsDrawn, &FrameCounters::horizonsBuilt,
        &FrameCounters::horizonsMoved, &FrameCounters::horizonsLeftOut, &FrameCounters::occlusionsLeftOut})
    this->*counter += other.*counter;
  return *this;
}

}  // namespace trimtab
