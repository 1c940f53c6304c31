# Debian packages: `cpack -G DEB` in the build folder makes them from the components that the folders install, with what is
# beside the programs: manual, completion, desktop entry, icon, file types, copyright and changelog. What no package should
# have but a person may need is a component too, see resources/docs/packages.md.
set(files ${PROJECT_SOURCE_DIR}/resources/packages)
set(made ${PROJECT_BINARY_DIR}/packages)
set(packages libtrimtab1 libtrimtab-dev)
if(NOT TRIMTAB_CORE_ONLY)
  list(APPEND packages trimtab trimtab-cli)
endif()

# Man pages and completion are what each program says of itself.
function(trimtab_manual PROGRAM COMPONENT)
  set(folder ${made}/manual/${PROGRAM})
  add_custom_command(OUTPUT ${folder}.done DEPENDS ${PROGRAM} VERBATIM COMMENT "Manual of ${PROGRAM}"
    COMMAND ${CMAKE_COMMAND} -E rm -rf ${folder}
    COMMAND ${PROGRAM} --write-manual ${folder}
    COMMAND sh -c "gzip -9n ${folder}/*.1"
    COMMAND ${CMAKE_COMMAND} -E touch ${folder}.done)
  add_custom_target(manual-${PROGRAM} ALL DEPENDS ${folder}.done)
  install(DIRECTORY ${folder}/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT ${COMPONENT} FILES_MATCHING PATTERN *.1.gz)
  install(FILES ${folder}/${PROGRAM}.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
          RENAME ${PROGRAM} COMPONENT ${COMPONENT})
endfunction()
if(NOT TRIMTAB_CORE_ONLY)
  trimtab_manual(trimtab workbench)
  trimtab_manual(trimtab-ig ig)
  trimtab_manual(trimtab-cli cli)
  install(FILES ${files}/trimtab.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications COMPONENT workbench)
  install(FILES ${files}/trimtab.metainfo.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/metainfo COMPONENT workbench)
  install(FILES ${files}/trimtab.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/mime/packages COMPONENT workbench)
  set(icons ${CMAKE_INSTALL_DATADIR}/icons/hicolor)
  install(FILES ${PROJECT_SOURCE_DIR}/resources/icons/trimtab.svg DESTINATION ${icons}/scalable/apps COMPONENT workbench)
  install(FILES ${PROJECT_SOURCE_DIR}/resources/icons/trimtab.png DESTINATION ${icons}/128x128/apps COMPONENT workbench)
endif()

set(TRIMTAB_MAINTAINER "The Trimtab authors <trimtab@trimtab.invalid>" CACHE STRING "Who answers for the Debian packages: NAME <ADDRESS>")
foreach(package ${packages})
  set(changelog ${made}/${package}/changelog.gz)
  add_custom_command(OUTPUT ${changelog} VERBATIM
    COMMAND bash ${files}/changelog.sh ${package} ${TRIMTAB_MAINTAINER} ${PROJECT_SOURCE_DIR}/CHANGELOG.md ${changelog}
    DEPENDS ${files}/changelog.sh ${PROJECT_SOURCE_DIR}/CHANGELOG.md)
  add_custom_target(changelog-${package} ALL DEPENDS ${changelog})
  install(FILES ${changelog} ${files}/copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package} COMPONENT doc-${package})
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT ${TRIMTAB_MAINTAINER})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has its own
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY ">=")  # the interface only grows
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_COMPONENTS_ALL "")

# trimtab_package(NAME SECTION section TITLE line TEXT text COMPONENTS component... [DEPENDS packages] [SUGGESTS packages])
# Lines of TEXT have at most 79 characters.
macro(trimtab_package NAME)
  cmake_parse_arguments(P "" "SECTION;TITLE;TEXT;DEPENDS;SUGGESTS" "COMPONENTS" ${ARGN})
  string(TOUPPER ${NAME} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${NAME})
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${P_SECTION})
  set(CPACK_DEBIAN_${upper}_PACKAGE_DEPENDS "${P_DEPENDS}")
  set(CPACK_DEBIAN_${upper}_PACKAGE_SUGGESTS "${P_SUGGESTS}")
  set(CPACK_DEBIAN_${upper}_DESCRIPTION "${P_TITLE}\n${P_TEXT}")
  foreach(component ${P_COMPONENTS} doc-${NAME})
    list(APPEND CPACK_COMPONENTS_ALL ${component})
    string(TOUPPER ${component} component_upper)
    set(CPACK_COMPONENT_${component_upper}_GROUP ${NAME})
  endforeach()
endmacro()
set(same_version "(= ${PROJECT_VERSION})")
trimtab_package(libtrimtab1 SECTION libs COMPONENTS interface
  TITLE "Decisions on culling and level of detail, as a shared library"
  TEXT "An image generator loads a preset of Trimtab, passes on what its host sends,
and gets the levers of each image.")
# Debian has ldconfig run by a trigger; cpack calls it in scripts.
file(WRITE ${made}/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_LIBTRIMTAB1_PACKAGE_CONTROL_EXTRA ${made}/triggers)
set(dev_components interface-dev core)
if(NOT TRIMTAB_CORE_ONLY)
  list(APPEND dev_components ig-dev)
  # The workbench runs trimtab-cli.
  trimtab_package(trimtab SECTION graphics COMPONENTS workbench ig DEPENDS "trimtab-cli ${same_version}"
    TITLE "Workbench that tunes culling and level of detail of image generators"
    TEXT "It draws terrain, follows a flight simulator's host over UDP, and shows at once
what each setting does to scheme, triangles, frame time and image error. It
exports presets. The reference image generator trimtab-ig, which loads them,
is included.")
  trimtab_package(trimtab-cli SECTION graphics COMPONENTS cli
    TITLE "Terrain, feeds and presets of image generators on the command line"
    TEXT "It bakes terrain databases, plays and records a host's packets, measures run
time against image error, and checks and exports presets.")
endif()
# trimtab::core links pugixml; the others are what trimtab::terrain and trimtab::scene link.
trimtab_package(libtrimtab-dev SECTION libdevel COMPONENTS ${dev_components}
  DEPENDS "libtrimtab1 ${same_version}, libpugixml-dev"
  SUGGESTS "libopenscenegraph-dev, libegl-dev, libmeshoptimizer-dev, nlohmann-json3-dev, zlib1g-dev"
  TITLE "Header, libraries and CMake packages of Trimtab"
  TEXT "It has the C header of libtrimtab, the static C++20 libraries below it, their
CMake and pkg-config files, examples, and the presets that ship.")
include(CPack)
