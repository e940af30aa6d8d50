# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
#
# The helpers of the build: hirosco_library, hirosco_executable, hirosco_test.

if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 12)
  message(FATAL_ERROR "HIROSCO needs g++ 12 or later (C++23 with std::expected); this is ${CMAKE_CXX_COMPILER_VERSION}")
endif()

set(CMAKE_CXX_STANDARD 23)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)

# One command for each file is for tools that read commands. All of a library takes three fifths of the time of ten, which is for who
# builds once, and a minute for whatever changes later (docs/adr/0122).
set(HIROSCO_COMPILE ten CACHE STRING "How many files of a library or program are compiled at a time: one, ten or all")
set_property(CACHE HIROSCO_COMPILE PROPERTY STRINGS one ten all)
if(NOT HIROSCO_COMPILE MATCHES "^(one|ten|all)$")
  message(FATAL_ERROR "HIROSCO_COMPILE is one, ten or all, not '${HIROSCO_COMPILE}'")
endif()
set(HIROSCO_SANITIZE "" CACHE STRING "Sanitizers to build with, for example 'address,undefined' or 'thread'")

add_library(hirosco_options INTERFACE)
target_include_directories(hirosco_options INTERFACE
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:include/hirosco>)
target_compile_features(hirosco_options INTERFACE cxx_std_23)
target_compile_options(hirosco_options INTERFACE
  # Of our own code; authors choose theirs.
  $<BUILD_INTERFACE:-Wall> $<BUILD_INTERFACE:-Wextra> $<BUILD_INTERFACE:-Wpedantic> $<BUILD_INTERFACE:-Wconversion>
  $<BUILD_INTERFACE:-Wshadow> $<BUILD_INTERFACE:-Werror>
  # One answer for one seed on every machine (docs/adr/0004): no fused multiply-add behind our back.
  -ffp-contract=off
  # A tenth of the time of g++ goes into tidying a heap that is given back at the end of a file anyway.
  $<$<CXX_COMPILER_ID:GNU>:$<BUILD_INTERFACE:SHELL:--param ggc-min-heapsize=1000000>>
  # std::ranges::stable_sort of libstdc++ 12 calls what C++17 deprecated.
  $<$<CXX_COMPILER_ID:Clang>:-Wno-deprecated-declarations>)
if(HIROSCO_SANITIZE)
  # -fPIC: all alike, so that all share compiled headers.
  target_compile_options(hirosco_options INTERFACE
    -fPIC -fsanitize=${HIROSCO_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  # Programs are large; gold, which comes with the linker of every Debian, takes a third of the time.
  find_program(HIROSCO_GOLD ld.gold)
  target_link_options(hirosco_options INTERFACE -fsanitize=${HIROSCO_SANITIZE} $<$<BOOL:${HIROSCO_GOLD}>:-fuse-ld=gold>)
  # These four make the build half as long again: ASan sees what the first three are after, and what is not aligned is
  # read by memcpy or byte by byte.
  if(HIROSCO_SANITIZE MATCHES undefined)
    target_compile_options(hirosco_options INTERFACE -fno-sanitize=vptr,null,object-size,alignment)
  endif()
endif()
# Who is linked with one function of a piece gets the others that it needs, not all of them: a program is read, hashed and relocated
# before it runs, and the start of a flight waits for that.
if(NOT HIROSCO_SANITIZE)
  target_compile_options(hirosco_options INTERFACE $<BUILD_INTERFACE:-ffunction-sections> $<BUILD_INTERFACE:-fdata-sections>)
  target_link_options(hirosco_options INTERFACE $<BUILD_INTERFACE:-Wl,--gc-sections>)
endif()
# Ten files in one piece: half the time to build. A change of one file compiles its piece, some ten seconds. With sanitizers it is the
# templates that take the time, each of them once in a piece: larger ones take two thirds of the time, for a change of one file twenty seconds.
if(NOT HIROSCO_COMPILE STREQUAL "one")
  set(CMAKE_UNITY_BUILD ON)
  set(CMAKE_UNITY_BUILD_BATCH_SIZE 10)
  if(HIROSCO_COMPILE STREQUAL "all")
    set(CMAKE_UNITY_BUILD_BATCH_SIZE 0)
  elseif(HIROSCO_SANITIZE)
    set(CMAKE_UNITY_BUILD_BATCH_SIZE 20)
  endif()
  # In a piece types of one file may use its anonymous namespace; the second one g++ 12 sees where there is none.
  target_compile_options(hirosco_options INTERFACE
    $<$<CXX_COMPILER_ID:GNU>:$<BUILD_INTERFACE:-Wno-subobject-linkage>>
    $<$<CXX_COMPILER_ID:GNU>:$<BUILD_INTERFACE:-Wno-free-nonheap-object>>
    # They tell of a name in the anonymous namespace of another file; `tools/tidy` compiles each file for itself.
    $<BUILD_INTERFACE:-Wno-shadow>)
endif()
if(NOT HIROSCO_COMPILE STREQUAL "one")
  # g++ 12 sees overlong strings in a piece where there are none, and whether it does hangs on what stands beside a file: nobody's build
  # is to end by that. Files that are compiled one at a time keep these words.
  target_compile_options(hirosco_options INTERFACE
    $<$<CXX_COMPILER_ID:GNU>:$<BUILD_INTERFACE:-Wno-array-bounds>> $<$<CXX_COMPILER_ID:GNU>:$<BUILD_INTERFACE:-Wno-restrict>>
    $<$<CXX_COMPILER_ID:GNU>:$<BUILD_INTERFACE:-Wno-stringop-overflow>>)
endif()

# -O3 costs a third more time to compile than it gives back here; bench/ would show it.
set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG")

# What is in no cycle gets less of the optimiser: it compiles in three quarters of the time (docs/adr/0116).
function(hirosco_compile_unhurried name)
  target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1>
    # What -O1 of g++ leaves out and templates live by.
    $<$<AND:$<CONFIG:Release>,$<CXX_COMPILER_ID:GNU>>:-finline-small-functions;-findirect-inlining>)
endfunction()

# The standard headers that nearly every file includes, compiled once for all libraries and programs: a tenth of the time to build.
# What modules share is compiled in another way than the rest, as is what has time, and so are their headers; with sanitizers all is
# compiled alike.
function(hirosco_compile_with_headers name)
  if(HIROSCO_COMPILE STREQUAL "one")
    return()
  endif()
  set(headers hirosco_headers)
  get_target_property(hidden ${name} VISIBILITY_INLINES_HIDDEN)
  get_target_property(options ${name} COMPILE_OPTIONS)
  if(hidden AND NOT HIROSCO_SANITIZE)
    set(headers hirosco_module_headers)
  endif()
  if(options MATCHES "-O1")
    string(APPEND headers _unhurried)
  endif()
  if(NOT TARGET ${headers})
    file(WRITE ${PROJECT_BINARY_DIR}/headers.cpp "")
    add_library(${headers} OBJECT ${PROJECT_BINARY_DIR}/headers.cpp)
    if(headers MATCHES "module")
      hirosco_for_modules(${headers})
    endif()
    if(headers MATCHES "unhurried")
      hirosco_compile_unhurried(${headers})
    endif()
    target_link_libraries(${headers} PRIVATE hirosco_options)
    target_precompile_headers(${headers} PRIVATE <algorithm> <array> <atomic> <chrono> <cmath> <deque> <expected> <filesystem>
      <functional> <map> <memory> <optional> <ranges> <set> <span> <string> <variant> <vector>)
  endif()
  target_precompile_headers(${name} REUSE_FROM ${headers})
endfunction()

# The same objects for programs and for modules, so that nothing is compiled twice; hidden, so that calls stay as direct as in a
# program (docs/adr/0050 has what it costs).
function(hirosco_for_modules name)
  set_target_properties(${name} PROPERTIES
    POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
endfunction()

# The headers that every test includes, compiled once, and tests themselves compiled for speed of building, eight files in one
# piece (with sanitizers fourteen, see above): together this is a third of the time. What is under test keeps its own options. In a piece names of the files of one
# target must differ.
# A second word is a header of ours that nearly all of its files include: it is compiled once, too.
function(hirosco_compile_as_test name)
  if(HIROSCO_COMPILE STREQUAL "ten")
    set(piece 8)
    if(HIROSCO_SANITIZE)
      set(piece 14)
    endif()
    set_target_properties(${name} PROPERTIES UNITY_BUILD_BATCH_SIZE ${piece})
  endif()
  # g++ 12 sees overlong string concatenations where there are none.
  target_compile_options(${name} PRIVATE
    $<$<CONFIG:Release>:-O1>
    $<$<AND:$<CONFIG:Release>,$<CXX_COMPILER_ID:GNU>>:-Wno-array-bounds;-Wno-restrict;-Wno-stringop-overflow>)
  set_target_properties(${name} PROPERTIES PCH_WARN_INVALID OFF)
  set(headers <gtest/gtest.h> <gmock/gmock.h> <algorithm> <array> <chrono> <expected> <functional> <map> <memory> <optional>
      <span> <string> <vector>)
  if(name STREQUAL "hirosco_test_headers")
    target_precompile_headers(${name} PRIVATE ${headers})
    return()
  endif()
  if(ARGN AND HIROSCO_SANITIZE AND HIROSCO_COMPILE STREQUAL "ten")
    target_precompile_headers(${name} PRIVATE ${headers} ${PROJECT_SOURCE_DIR}/${ARGN})
    return()
  endif()
  if(NOT TARGET hirosco_test_headers)
    file(WRITE ${PROJECT_BINARY_DIR}/test_headers.cpp "")
    add_library(hirosco_test_headers OBJECT ${PROJECT_BINARY_DIR}/test_headers.cpp)
    target_link_libraries(hirosco_test_headers PRIVATE hirosco_options GTest::gtest GTest::gmock)
    hirosco_compile_as_test(hirosco_test_headers)
  endif()
  target_precompile_headers(${name} REUSE_FROM hirosco_test_headers)
endfunction()

# Every module of this repository, for what loads them.
add_custom_target(hirosco_modules)

# All that tests of real processes need: programs, modules, page, libraries for authors. ./check builds of the tests themselves what those
# need that it runs (tests/turns.py): with the sanitizers those labelled `unit` or `concurrency`, optimised all others.
add_custom_target(flown)

# hirosco_test(NAME SOURCES f_test.cpp... DEPENDS targets... [LABELS unit] [COST seconds] [HEADER file] [SLICED])
# One GoogleTest executable; ctest runs it once as a whole, which keeps the suite fast. Labels: unit (the default) beside
# the code; concurrency: threads meet, so under TSan; figures: flies simulations, which takes minutes under a sanitizer; tools: of
# what people use beside a flight, which reads nothing from outside a computer and guards nothing, so its libraries are built with sanitizers in ./check --all only;
# stops (guard, permission, reactions): tests of a library a second time, optimised, so that every check has them;
# allocations (whoever counts them): a sanitizer owns the heap functions; endtoend, realtime, fault: real processes, alone on
# the machine; long: in ./check --all only. COST: of those that take longest, which begin first. SLICED: it takes a part of what it could
# try (hirosco/utilities/testing/slice.hpp); NAME_whole takes all of it and is `long`.
function(hirosco_test name)
  cmake_parse_arguments(ARG "SLICED" "COST;HEADER" "SOURCES;DEPENDS;LABELS" ${ARGN})
  if(NOT BUILD_TESTING)
    return()
  endif()
  if(ARG_DEPENDS MATCHES "hirosco_(malloc|realtime)_hook")
    # Whose heap functions are a sanitizer's, or those of another C library, has no hook.
    if(HIROSCO_SANITIZE OR NOT HIROSCO_OS STREQUAL "linux")
      return()
    endif()
    set(ARG_LABELS allocations)
  endif()
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE hirosco_options ${ARG_DEPENDS} GTest::gtest GTest::gmock GTest::gtest_main)
  target_compile_definitions(${name} PRIVATE HIROSCO_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
                                             HIROSCO_BINARY_DIR="${PROJECT_BINARY_DIR}")
  # As an author's outside (HiroscoAuthor.cmake): a rig fails the test of a subsystem whose cycle does what real time forbids (docs/adr/0230).
  if(ARG_DEPENDS MATCHES "hirosco::subsystem_testing" AND NOT ARG_DEPENDS MATCHES "hirosco_(malloc|realtime)_hook" AND NOT HIROSCO_SANITIZE)
    target_sources(${name} PRIVATE $<TARGET_OBJECTS:hirosco_realtime_hook>)
    target_link_libraries(${name} PRIVATE ${CMAKE_DL_LIBS})
  endif()
  hirosco_compile_as_test(${name} ${ARG_HEADER})
  add_test(NAME ${name} COMMAND ${name})
  if(NOT ARG_LABELS)
    set(ARG_LABELS unit)
  endif()
  set_tests_properties(${name} PROPERTIES LABELS "${ARG_LABELS}")
  if(ARG_COST)
    set_tests_properties(${name} PROPERTIES COST ${ARG_COST})
  endif()
  if(ARG_SLICED)
    add_test(NAME ${name}_whole COMMAND ${name})
    set_tests_properties(${name}_whole PROPERTIES LABELS "${ARG_LABELS};long" ENVIRONMENT HIROSCO_SLICE=whole)
  endif()
  foreach(label IN LISTS ARG_LABELS)
    if(label MATCHES "^(endtoend|realtime|fault)$")
      set_tests_properties(${name} PROPERTIES RUN_SERIAL ON)
    endif()
  endforeach()
endfunction()

# hirosco_library(NAME [IN_MODULES] [UNHURRIED] [OWN_HEADERS] SOURCES *.cpp TESTS *_test.cpp DEPENDS targets... [LABELS of the test...]
#   [SLICED] [TEST_HEADER file] [EXAMPLE example.cpp])
# IN_MODULES: subsystems and devices use it, so it can be linked into their modules. UNHURRIED: nothing of it is in a cycle or on
# the way of a sample. OWN_HEADERS: it compiles headers of its own.
# Makes the library hirosco::NAME, its test NAME_test, and its example NAME_example (run as a test).
function(hirosco_library name)
  cmake_parse_arguments(ARG "IN_MODULES;UNHURRIED;OWN_HEADERS;SLICED" "EXAMPLE;TEST_HEADER" "SOURCES;TESTS;DEPENDS;LABELS" ${ARGN})
  add_library(hirosco_${name} STATIC ${ARG_SOURCES})
  add_library(hirosco::${name} ALIAS hirosco_${name})
  if(ARG_IN_MODULES)
    hirosco_for_modules(hirosco_${name})
  endif()
  if(ARG_UNHURRIED)
    hirosco_compile_unhurried(hirosco_${name})
  endif()
  target_link_libraries(hirosco_${name} PUBLIC hirosco_options ${ARG_DEPENDS})
  if(NOT ARG_OWN_HEADERS)
    hirosco_compile_with_headers(hirosco_${name})
  endif()
  if(ARG_TESTS)
    set(sliced)
    if(ARG_SLICED)
      set(sliced SLICED)
    endif()
    hirosco_test(${name}_test SOURCES ${ARG_TESTS} DEPENDS hirosco::${name} LABELS ${ARG_LABELS} HEADER ${ARG_TEST_HEADER} ${sliced})
  endif()
  if(ARG_EXAMPLE AND BUILD_TESTING)
    add_executable(${name}_example ${ARG_EXAMPLE})
    target_link_libraries(${name}_example PRIVATE hirosco::${name})
    hirosco_compile_with_headers(${name}_example)
    add_test(NAME ${name}_example COMMAND ${name}_example)
    set_tests_properties(${name}_example PROPERTIES LABELS example)
  endif()
endfunction()

# hirosco_executable(NAME [UNHURRIED] [INSTALL] SOURCES *.cpp DEPENDS targets...)
function(hirosco_executable name)
  cmake_parse_arguments(ARG "INSTALL;UNHURRIED" "" "SOURCES;DEPENDS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  if(ARG_UNHURRIED)
    hirosco_compile_unhurried(${name})
  endif()
  target_link_libraries(${name} PRIVATE hirosco_options ${ARG_DEPENDS})
  hirosco_compile_with_headers(${name})
  if(ARG_INSTALL)
    install(TARGETS ${name} RUNTIME DESTINATION bin)
  endif()
  get_directory_property(on_demand EXCLUDE_FROM_ALL)  # as bench/
  if(NOT on_demand)
    add_dependencies(flown ${name})
  endif()
endfunction()
