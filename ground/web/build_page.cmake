# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
#
# The build step of CMakeLists.txt: works in the build folder, so that the sources stay as they are. What fails is said
# and ends nothing, nor is it tried again by itself, which costs offline builds their time: a spacecraft flies without
# its page.

foreach(file IN ITEMS package.json package-lock.json .npmrc build.mjs fonts.mjs)
  configure_file(${sources}/${file} ${work}/${file} COPYONLY)
endforeach()
file(SHA256 ${sources}/package-lock.json wanted)
set(installed "")
if(EXISTS ${work}/node_modules/installed)
  file(READ ${work}/node_modules/installed installed)
endif()
if(NOT installed STREQUAL wanted)
  execute_process(COMMAND ${npm} ci --prefer-offline --fetch-retries=1 WORKING_DIRECTORY ${work}
    RESULT_VARIABLE failed OUTPUT_QUIET ERROR_VARIABLE why)
  if(failed)
    string(REGEX REPLACE "\n.*" "" why "${why}")
    message(NOTICE "The ground station's page is left out: npm could not fetch its packages (${why}).\n"
      "To try again: rm ${stamp}, and build.")
    file(TOUCH ${stamp})
    return()
  endif()
  file(WRITE ${work}/node_modules/installed ${wanted})
endif()
execute_process(COMMAND ${node} build.mjs ${page} ${sources} WORKING_DIRECTORY ${work} RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "The ground station's page does not build.")
endif()
file(TOUCH ${stamp})
