#pragma once

#include "report.h"

/// The rows that the documents print, with the column names of their tables here.
namespace trimtab::experiment {

/// Documents A and B, comparison of three culling cases. A and B differ in the vertices of *proposed*, and B
/// prints 16.65 fps for the first row: both counts are given.
Table publishedCulling();
/// Document C, results.
Table publishedHeadMotion();
/// Document D, frame rates with weather.
Table publishedWeather();
/// Document E, the example tile.
Table publishedStaticLod();

}  // namespace trimtab::experiment
