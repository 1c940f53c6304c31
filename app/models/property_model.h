#pragma once

#include <osg/Node>
#include <osgDB/Options>

#include <functional>
#include <string>

#include "trimtab/units/result.h"

namespace trimtab::models {

/// Says what is wrong: severity, what it is about, what was expected, what was found.
using SayOfModel = std::function<void(Severity, const std::string& key, const std::string& expected,
                                      const std::string& found)>;

/// Reads a model that FlightGear describes by a PropertyList (`.xml`): the model in `path`, turned and moved
/// by `offsets`, and each `model` inside it the same way. A file is looked for beside the list, then below
/// each folder above it, so that names below FlightGear's base folder are found. x points aft (south as
/// placed at heading 0), y right and z up; `.ac` files inside, whose y is up, are turned.
///
/// Animations of type `range` become osg::LOD by their `min-m` and `max-m`. `select` and the condition of a
/// submodel show what they show while no property is set: each counts as 0, as false and as an empty text, so
/// it is day. Other types change nothing, and are counted. Returns null if there is nothing to draw; what is
/// not there, no XML, or no number that makes sense is said, and the rest is read. Files inside are opened
/// through osgDB, whose callback ends cycles.
///
/// Source: FlightGear's wiki, "Modeling: Animations" and "Model XML"; SimGear's SGReaderWriterXML: pitch is
/// about y, then roll about x, then heading about z, then the move.
osg::ref_ptr<osg::Node> readPropertyModel(const std::string& file, const osgDB::Options* options,
                                          const SayOfModel& say);

}  // namespace trimtab::models
