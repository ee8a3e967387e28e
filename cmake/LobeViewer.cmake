# The web page that shows solutions: viewer/, built by npm into viewer/ of the build tree, where `lobe` finds it.
# No add_subdirectory: CMake's own files would come to lie in that folder.
set(LOBE_VIEWER_BUNDLE ${CMAKE_BINARY_DIR}/viewer)
install(DIRECTORY ${LOBE_VIEWER_BUNDLE}/ DESTINATION share/lobe/viewer OPTIONAL)

set(viewer_source ${PROJECT_SOURCE_DIR}/viewer)
if(LOBE_VIEWER STREQUAL "OFF")
  return()
endif()
find_program(LOBE_NPM npm)
if(NOT LOBE_NPM OR NOT EXISTS ${viewer_source}/package.json)
  if(LOBE_VIEWER STREQUAL "ON")
    message(FATAL_ERROR "LOBE_VIEWER is ON, but npm or viewer/package.json is missing; Node.js 18 or newer is needed")
  endif()
  message(STATUS "npm or viewer/ is missing, so no page is built: `lobe view` and `lobe export` will need --viewer")
  return()
endif()

# Not the folder as a whole: node_modules in it has thousands of files.
file(GLOB viewer_files CONFIGURE_DEPENDS
  ${viewer_source}/*.json ${viewer_source}/*.html ${viewer_source}/*.ts ${viewer_source}/*.js)
file(GLOB_RECURSE viewer_sources CONFIGURE_DEPENDS ${viewer_source}/src/* ${viewer_source}/public/*)

# The stamp says that it was tried: where npm finds no network, not every build waits for it again. Configuring
# does away with the stamp of an attempt that failed.
set(viewer_stamp ${CMAKE_BINARY_DIR}/viewer.stamp)
if(NOT EXISTS ${LOBE_VIEWER_BUNDLE}/index.html)
  file(REMOVE ${viewer_stamp})
endif()
set(optional "")
if(LOBE_VIEWER STREQUAL "AUTO")
  set(optional --optional)
endif()
add_custom_command(
  OUTPUT ${viewer_stamp}
  COMMAND ${CMAKE_COMMAND} -E env NPM=${LOBE_NPM} bash ${viewer_source}/build.sh ${optional} ${LOBE_VIEWER_BUNDLE}
  COMMAND ${CMAKE_COMMAND} -E touch ${viewer_stamp}
  DEPENDS ${viewer_files} ${viewer_sources} ${viewer_source}/build.sh
  COMMENT "Building the viewer's page"
  VERBATIM)
add_custom_target(viewer ALL DEPENDS ${viewer_stamp})
