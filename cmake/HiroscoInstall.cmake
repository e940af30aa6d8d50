# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
#
# What an installed tree has (docs/adr/0051): bin, lib/hirosco with modules, and for authors include/hirosco and a CMake package
# with the libraries; share/hirosco with missions, descriptors and page, laid out as in the sources.
include(CMakePackageConfigHelpers)

# hirosco_headers_of(RESULT headers...): these and what they include, as paths from the top of the sources.
function(hirosco_headers_of result)
  set(left ${ARGN})
  set(found "")
  while(left)
    list(POP_FRONT left header)
    if(header IN_LIST found)
      continue()
    endif()
    list(APPEND found ${header})
    file(STRINGS ${PROJECT_SOURCE_DIR}/${header} lines REGEX "^#include \"")
    list(TRANSFORM lines REPLACE "^#include \"(.*)\".*" "\\1")
    list(APPEND left ${lines})
  endwhile()
  list(SORT found)
  set(${result} ${found} PARENT_SCOPE)
endfunction()

# What an author includes: all of the author's folder, and what a guide or an example to copy names besides (tools/check_author_headers.py holds
# them to it). Whatever else these include is installed with them, and nothing else is.
file(GLOB hirosco_author_folder_headers RELATIVE ${PROJECT_SOURCE_DIR} CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/hirosco/subsystem/author/*.hpp)
hirosco_headers_of(HIROSCO_AUTHOR_HEADERS ${hirosco_author_folder_headers}
  hirosco/subsystem/testing/rig.hpp hirosco/subsystem/testing/tried_functions.hpp hirosco/subsystem/process/run.hpp
  hirosco/descriptor/read/read.hpp hirosco/pus/st03_housekeeping/housekeeping_decoder.hpp
  hirosco/data_transfer/device/device_frame.hpp hirosco/data_transfer/device/frame_protocol.hpp hirosco/utilities/crc16.hpp
  hirosco/resource/counted.hpp hirosco/resource/pool_allocator.hpp hirosco/resource/pool_resource.hpp
  robotics/dynamics/integrator.hpp robotics/motion/inverse_kinematics.hpp robotics/motion/point_to_point.hpp robotics/urdf/robot.hpp
  simulation/devices/device_shell.hpp simulation/devices/module.hpp simulation/devices/simulated_device.hpp)

# What a module and who loads it have to agree on: the module's copy of the libraries works on the object of the framework that stands behind
# its author's class (service_loop/author_calls.cpp), whose headers nobody includes outside. interface_version is a sum over these (docs/adr/0050).
hirosco_headers_of(HIROSCO_INTERFACE_HEADERS ${HIROSCO_AUTHOR_HEADERS} hirosco/subsystem/service_loop/generic_subsystem.hpp)

# hirosco_install_libraries(targets...): hirosco_NAME becomes hirosco::NAME of the package.
function(hirosco_install_libraries)
  foreach(target IN LISTS ARGN)
    string(REGEX REPLACE "^hirosco_" "" short ${target})
    set_target_properties(${target} PROPERTIES EXPORT_NAME ${short})
    add_dependencies(flown ${target})
  endforeach()
  install(TARGETS ${ARGN} EXPORT hirosco-targets ARCHIVE DESTINATION lib/hirosco OBJECTS DESTINATION lib/hirosco)
endfunction()

function(hirosco_install)
  hirosco_install_libraries(hirosco_options hirosco_utilities hirosco_resource hirosco_xml hirosco_parameter
    hirosco_data_transfer hirosco_descriptor hirosco_pus hirosco_dynamics hirosco_motion hirosco_urdf hirosco_subsystem hirosco_subsystem_main hirosco_subsystem_testing
    hirosco_simulated_device hirosco_simulation_device_shell hirosco_device_main hirosco_realtime_hook)
  foreach(header IN LISTS HIROSCO_AUTHOR_HEADERS)
    get_filename_component(folder ${header} DIRECTORY)
    install(FILES ${PROJECT_SOURCE_DIR}/${header} DESTINATION include/hirosco/${folder})
  endforeach()

  set(package lib/cmake/hirosco)
  install(EXPORT hirosco-targets NAMESPACE hirosco:: DESTINATION ${package})
  configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/hirosco-config.cmake.in
    ${PROJECT_BINARY_DIR}/hirosco-config.cmake INSTALL_DESTINATION ${package})
  # Before 1.0 a minor version may change what an author sees.
  write_basic_package_version_file(${PROJECT_BINARY_DIR}/hirosco-config-version.cmake COMPATIBILITY SameMinorVersion)
  install(FILES ${PROJECT_BINARY_DIR}/hirosco-config.cmake ${PROJECT_BINARY_DIR}/hirosco-config-version.cmake
    cmake/HiroscoAuthor.cmake cmake/hirosco_module.map DESTINATION ${package})

  set(share share/hirosco)
  install(DIRECTORY subsystems supervisor DESTINATION ${share} FILES_MATCHING PATTERN *.xml PATTERN *.urdf PATTERN *.script
    PATTERN tests EXCLUDE)
  install(DIRECTORY hirosco/descriptor/ DESTINATION ${share}/schemas FILES_MATCHING PATTERN *.xsd PATTERN testdata EXCLUDE)
  install(DIRECTORY ${PROJECT_BINARY_DIR}/${share}/page DESTINATION ${share} OPTIONAL)
  install(DIRECTORY templates DESTINATION ${share})
  set(doc share/doc/hirosco)
  install(DIRECTORY docs/guide DESTINATION ${doc})
  install(FILES docs/installed/README.md docs/descriptor-errors.md docs/urdf-errors.md docs/failure-codes.md docs/interfaces.md CHANGELOG.md DESTINATION ${doc})
  # What the guide says to copy: each folder is whole.
  install(DIRECTORY tests/author/lamp tests/author/pair DESTINATION ${doc}/examples)
  install(FILES simulation/devices/reference/device.c simulation/devices/reference/device.py simulation/devices/reference/arm.py simulation/devices/reference/drives.py tests/devices/duties_test.py tests/devices/own_device.py tests/devices/local_wires.py
    tests/devices/reference.py tests/devices/line_protocol.hpp tests/devices/line_protocol.cpp DESTINATION ${doc}/examples/device)
  install(DIRECTORY LICENSES DESTINATION ${doc})
endfunction()
