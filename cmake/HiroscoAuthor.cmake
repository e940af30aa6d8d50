# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
#
# What an author builds, in this repository or in one that found the package: hirosco_subsystem, hirosco_device.

# hirosco_subsystem(NAME SOURCES *.cpp [DEPENDS targets...] [MAIN main.cpp] [NOT_INSTALLED])
# hirosco_device(NAME SOURCES *.cpp [DEPENDS targets...] [MAIN main.cpp] [NOT_INSTALLED])
# A part of a mission: the program NAME, and the module NAME.so beside it, for `hirosco simulate`. One of the sources defines
# hirosco_module(). They are compiled once, into NAME_objects, which tests link. MAIN: a main() of the program's own in place
# of the one that runs the module. Both are installed, into bin and lib/hirosco, unless they are a
# test's or whoever makes them says where.
function(hirosco_subsystem name)
  hirosco_part(${name} hirosco::subsystem_main hirosco::subsystem ${ARGN})
endfunction()

function(hirosco_device name)
  hirosco_part(${name} hirosco::device_main hirosco::simulated_device ${ARGN})
endfunction()

# Whether what cycles must not do is seen: as HIROSCO_WATCH_CYCLES says, and `otherwise` where it says nothing. A sanitizer owns the functions
# that would have to be seen.
function(hirosco_watched result otherwise)
  string(TOUPPER "${CMAKE_BUILD_TYPE}" type)
  get_directory_property(options COMPILE_OPTIONS)
  set(watched ${otherwise})
  if(HIROSCO_SANITIZE OR "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${type}} ${options}" MATCHES "-fsanitize=")
    set(watched OFF)
  elseif(DEFINED HIROSCO_WATCH_CYCLES)
    set(watched ${HIROSCO_WATCH_CYCLES})
  endif()
  set(${result} ${watched} PARENT_SCOPE)
endfunction()

# hirosco_watch(NAME): the program of a subsystem tells it by CYCLE_NOT_REALTIME, in Debug builds (docs/adr/0092); a test that links NAME_objects
# fails by its rig, in every build (docs/adr/0230).
function(hirosco_watch name)
  set(development OFF)
  if(CMAKE_BUILD_TYPE STREQUAL "Debug")
    set(development ON)
  endif()
  hirosco_watched(of_program ${development})
  if(of_program)
    target_sources(${name} PRIVATE $<TARGET_OBJECTS:hirosco::realtime_hook>)
    target_link_libraries(${name} PRIVATE ${CMAKE_DL_LIBS})
  endif()
  hirosco_watched(of_tests ON)
  if(of_tests)
    target_sources(${name}_objects INTERFACE $<TARGET_OBJECTS:hirosco::realtime_hook>)
    target_link_libraries(${name}_objects INTERFACE ${CMAKE_DL_LIBS})
  endif()
endfunction()

set(hirosco_author_folder ${CMAKE_CURRENT_LIST_DIR})

# `main`: the library of the program; `framework`: of both.
function(hirosco_part name main framework)
  cmake_parse_arguments(ARG "NOT_INSTALLED" "MAIN" "SOURCES;DEPENDS" ${ARGN})
  add_library(${name}_objects OBJECT ${ARG_SOURCES})
  target_link_libraries(${name}_objects PUBLIC ${ARG_DEPENDS} ${framework})
  set_target_properties(${name}_objects PROPERTIES
    POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)

  if(ARG_MAIN)
    add_executable(${name} ${ARG_MAIN})
    target_link_libraries(${name} PRIVATE ${main} ${ARG_DEPENDS} ${framework})
  else()
    add_executable(${name} $<TARGET_OBJECTS:${name}_objects>)
    target_link_libraries(${name} PRIVATE ${main} ${ARG_DEPENDS} ${framework})
    set_target_properties(${name} PROPERTIES LINKER_LANGUAGE CXX)
  endif()
  if(main STREQUAL hirosco::subsystem_main)
    hirosco_watch(${name})
  endif()

  add_library(${name}_module MODULE $<TARGET_OBJECTS:${name}_objects>)
  target_link_libraries(${name}_module PRIVATE ${ARG_DEPENDS} ${framework})
  set(map ${hirosco_author_folder}/hirosco_module.map)
  target_link_options(${name}_module PRIVATE -Wl,--version-script=${map})
  # What is missing is told here and not to who loads it; the run-time libraries of sanitizers come with the program.
  if(NOT HIROSCO_SANITIZE)
    target_link_options(${name}_module PRIVATE -Wl,-z,defs)
  endif()
  set_target_properties(${name}_module PROPERTIES
    LINKER_LANGUAGE CXX PREFIX "" OUTPUT_NAME ${name} SUFFIX .so LINK_DEPENDS ${map})
  if(CMAKE_RUNTIME_OUTPUT_DIRECTORY)
    set_target_properties(${name}_module PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${CMAKE_RUNTIME_OUTPUT_DIRECTORY})
  endif()
  if(TARGET hirosco_modules)  # in this repository
    add_dependencies(hirosco_modules ${name}_module)
    add_dependencies(flown ${name} ${name}_module)
  endif()
  if(NOT ARG_NOT_INSTALLED)
    install(TARGETS ${name} RUNTIME DESTINATION bin)
    install(TARGETS ${name}_module LIBRARY DESTINATION lib/hirosco)
  endif()
endfunction()
