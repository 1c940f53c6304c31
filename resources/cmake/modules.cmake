# One place that says how a folder becomes a target, and what every target is compiled with.

add_library(trimtab_warnings INTERFACE)
target_compile_options(trimtab_warnings INTERFACE -Wall -Wextra -Wpedantic -Wconversion -Wshadow)
# g++ 12 sees overlaps in every `"text" + string` (GCC bug 105651).
target_compile_options(trimtab_warnings INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
if(TRIMTAB_WERROR)
  target_compile_options(trimtab_warnings INTERFACE -Werror)
endif()
if(TRIMTAB_SANITIZE)
  # Without the second option a program that did something undefined says so and ends well.
  add_compile_options(-fsanitize=${TRIMTAB_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
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

# A compiler spends most of its time here on headers, so it reads eight sources of one target at once where their names
# allow it: names in unnamed namespaces must differ then. Off, each source is compiled alone, which shows a missing
# #include.
option(TRIMTAB_TOGETHER "Compile sources eight at a time" ON)
function(trimtab_together TARGET)
  set_target_properties(${TARGET} PROPERTIES UNITY_BUILD ${TRIMTAB_TOGETHER} UNITY_BUILD_BATCH_SIZE 8)
  if(TRIMTAB_TOGETHER AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # g++ takes an included source for a header, in which such members would be wrong.
    target_compile_options(${TARGET} PRIVATE -Wno-subobject-linkage)
  endif()
endfunction()

# trimtab_module(NAME SOURCES file... [DEPENDS target...] [PRIVATE target...])
#
# A room of core/ as a static library trimtab_NAME. What others may use is in its folder include/ and is included as
# "trimtab/MODULE/file.h"; only dependants of the target see that folder, so a room that includes what it does not link
# against does not compile. Everything else is private and stays beside its source.
function(trimtab_module NAME)
  trimtab_folder(${NAME} ${ARGN})
  target_include_directories(trimtab_${NAME} PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>
                                                    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
endfunction()

# trimtab_folder(NAME SOURCES file... [DEPENDS target...] [PRIVATE target...])
#
# A folder of the programs or of the views as a static library trimtab_NAME. Headers of another folder are included by
# their path from the root of the tree; tests/house_test.cpp checks that only folders lower down are.
function(trimtab_folder NAME)
  cmake_parse_arguments(M "" "" "SOURCES;DEPENDS;PRIVATE" ${ARGN})
  add_library(trimtab_${NAME} STATIC ${M_SOURCES})
  target_include_directories(trimtab_${NAME} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(trimtab_${NAME} PUBLIC ${M_DEPENDS} PRIVATE $<BUILD_INTERFACE:trimtab_warnings> ${M_PRIVATE})
  target_compile_features(trimtab_${NAME} PUBLIC cxx_std_20)
endfunction()

# trimtab_test(NAME SOURCES file... LIBS target... [DISPLAY] [SEPARATE] [HEADERS_OF test])
#
# One GoogleTest program, build/bin/NAME, listed for tests/run.sh. DISPLAY: it needs an X server. SEPARATE: names in its
# sources collide, so that they are not compiled together. All programs share the
# precompiled headers of test_house, or of the test that HEADERS_OF names. Most of a test's time to build is spent on
# headers and on optimising code that runs once, hence -O1; what is tested is compiled as users get it.
# Tests find real data by sharedDir() (tests/support.h), and skip with a message where there is none.
function(trimtab_test NAME)
  cmake_parse_arguments(T "DISPLAY;SEPARATE" "HEADERS_OF" "SOURCES;LIBS" ${ARGN})
  add_executable(${NAME} ${T_SOURCES})
  target_link_libraries(${NAME} PRIVATE ${T_LIBS} trimtab_warnings trimtab_test_support GTest::gmock GTest::gtest_main)
  target_compile_options(${NAME} PRIVATE $<$<CONFIG:Release>:-O1>)
  if(NOT T_SEPARATE)
    trimtab_together(${NAME})
  endif()
  if(NOT T_HEADERS_OF)
    set(T_HEADERS_OF test_house)
  endif()
  if(NAME STREQUAL T_HEADERS_OF)
    target_precompile_headers(${NAME} PRIVATE <gmock/gmock.h> <gtest/gtest.h> <filesystem> <fstream> <functional> <random>)
  else()
    target_precompile_headers(${NAME} REUSE_FROM ${T_HEADERS_OF})
  endif()
  if(T_DISPLAY)
    set_property(GLOBAL APPEND PROPERTY TRIMTAB_TESTS_LIST "${NAME} display")
  else()
    set_property(GLOBAL APPEND PROPERTY TRIMTAB_TESTS_LIST "${NAME} plain")
  endif()
endfunction()
