#pragma once

#include <filesystem>
#include <string>

#include "trimtab/terrain/objects/source_model.h"
#include "trimtab/units/result.h"

namespace trimtab::models {

/// Returns the endings of the files that readModel() reads, for help and messages.
std::string modelFormats();

/// Reads a model: .flt, .ive, .osgb, .osgt, .osg, .3ds, .obj, .ac, .dae, .ply, .stl, or a
/// FlightGear model list in .xml (property_model.h). Axes are those of
/// SourceModel, so z is up: in .ac, as FlightGear writes it, and in .obj y is up, and is turned; .dae says
/// which is. The same files give the same bytes. Units are metres: what a file says of others is not read.
/// Not for use by several threads at once. A name "/vsizip/ARCHIVE/NAME" is a file in a zip archive.
///
/// OpenFlight's levels of detail without ranges switch by their significant sizes (open_flight.h). Textures
/// of a CDB are found at the level W that there is, and in its archives (trimtab/terrain/cdb/models.h).
///
/// Colours are those of vertices or of materials; only the texture of unit 0 is read. Findings of success
/// name textures and references that are not there, and what OpenSceneGraph had to say.
Result<terrain::SourceModel> readModel(const std::filesystem::path& file);

}  // namespace trimtab::models
