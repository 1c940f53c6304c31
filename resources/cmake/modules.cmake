# One place that says how a folder becomes a target, and what every target is compiled with.

add_library(trimtab_warnings INTERFACE)
target_compile_options(trimtab_warnings INTERFACE -Wall -Wextra -Wpedantic -Wconversion -Wshadow)
# g++ 12 sees overlaps in every `"text" + string` (GCC bug 105651).
target_compile_options(trimtab_warnings INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
if(TRIMTAB_WERROR)
  target_compile_options(trimtab_warnings INTERFACE -Werror)
endif()
if(TRIMTAB_SANITIZE)
  add_compile_options(-fsanitize=${TRIMTAB_SANITIZE} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${TRIMTAB_SANITIZE})
endif()
# Replays are compared bit for bit between programs, so no target may contract a*b+c on its own.
add_compile_options(-ffp-contract=off)

find_program(TRIMTAB_MOLD mold)
if(TRIMTAB_MOLD AND NOT TRIMTAB_SANITIZE)
  add_link_options(-fuse-ld=mold)
endif()
find_program(TRIMTAB_CCACHE ccache)
if(TRIMTAB_CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${TRIMTAB_CCACHE})
endif()

# trimtab_module(NAME SOURCES file... [DEPENDS target...] [PRIVATE target...])
#
# A folder of the tree as a static library trimtab_NAME. Its headers are included as "trimtab/NAME/file.h", by way
# of a link in the build tree that only dependants of the target can see: a folder that includes what it does not
# link against does not compile. That is how the layer rule is enforced.
function(trimtab_module NAME)
  cmake_parse_arguments(M "" "" "SOURCES;DEPENDS;PRIVATE" ${ARGN})
  set(include_root ${PROJECT_BINARY_DIR}/include/${NAME})
  file(MAKE_DIRECTORY ${include_root}/trimtab)
  file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR} ${include_root}/trimtab/${NAME} SYMBOLIC)
  if(M_SOURCES)
    add_library(trimtab_${NAME} STATIC ${M_SOURCES})
    target_include_directories(trimtab_${NAME} PUBLIC $<BUILD_INTERFACE:${include_root}>
                                                      $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    target_link_libraries(trimtab_${NAME} PUBLIC ${M_DEPENDS} PRIVATE $<BUILD_INTERFACE:trimtab_warnings> ${M_PRIVATE})
    target_compile_features(trimtab_${NAME} PUBLIC cxx_std_20)
  else()
    add_library(trimtab_${NAME} INTERFACE)
    target_include_directories(trimtab_${NAME} INTERFACE $<BUILD_INTERFACE:${include_root}>
                                                         $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    target_link_libraries(trimtab_${NAME} INTERFACE ${M_DEPENDS})
    target_compile_features(trimtab_${NAME} INTERFACE cxx_std_20)
  endif()
endfunction()

# trimtab_test(NAME SOURCES file... LIBS target... [DISPLAY] [ARGS arg...])
#
# One GoogleTest program, build/bin/NAME, listed for tests/run.sh. DISPLAY: it needs an X server.
# Tests find real data by trimtab_test_data() (tests/support.h), and skip with a message where there is none.
function(trimtab_test NAME)
  cmake_parse_arguments(T "DISPLAY" "" "SOURCES;LIBS" ${ARGN})
  add_executable(${NAME} ${T_SOURCES})
  target_link_libraries(${NAME} PRIVATE ${T_LIBS} trimtab_warnings trimtab_test_support GTest::gmock GTest::gtest_main)
  if(T_DISPLAY)
    set_property(GLOBAL APPEND PROPERTY TRIMTAB_TESTS_LIST "${NAME} display")
  else()
    set_property(GLOBAL APPEND PROPERTY TRIMTAB_TESTS_LIST "${NAME} plain")
  endif()
endfunction()
