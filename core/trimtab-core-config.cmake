include(CMakeFindDependencyMacro)
find_dependency(pugixml)  # property lists in XML
include(${CMAKE_CURRENT_LIST_DIR}/trimtab-core-targets.cmake)
