#pragma once

#include <osg/State>

namespace trimtab::scene {

/// Undoes what others who share the context changed behind OSG's back, and for them what OSG changed. Call it
/// before and after OSG draws. State::dirtyAllModes only flips what OSG believes, so this brings that and the
/// true state together.
void settle(osg::State& state);

}  // namespace trimtab::scene
