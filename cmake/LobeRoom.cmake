# One room of the house: a static library NAME from SOURCES, using the rooms and
# packages in USES. Rooms see headers from the root ("sh/zernike.h").
add_library(lobe_flags INTERFACE)
target_include_directories(lobe_flags INTERFACE ${PROJECT_SOURCE_DIR})
target_compile_features(lobe_flags INTERFACE cxx_std_20)
target_compile_options(lobe_flags INTERFACE -Wall -Wextra -Wshadow=local -Wnon-virtual-dtor)
if(LOBE_WARNINGS_AS_ERRORS)
  target_compile_options(lobe_flags INTERFACE -Werror)
endif()
if(LOBE_NATIVE)
  target_compile_options(lobe_flags INTERFACE -march=native)
elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  # Hot kernels carry clones for newer processors and choose at start (sh/simd.h).
  target_compile_options(lobe_flags INTERFACE -march=x86-64-v2)
endif()
if(LOBE_SANITIZE)
  target_compile_options(lobe_flags INTERFACE -fsanitize=${LOBE_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(lobe_flags INTERFACE -fsanitize=${LOBE_SANITIZE})
  # Function multiversioning resolves before the sanitizer runtimes are up.
  target_compile_definitions(lobe_flags INTERFACE LOBE_NO_SIMD_CLONES)
endif()
if(LOBE_COVERAGE)
  target_compile_options(lobe_flags INTERFACE --coverage)
  target_link_options(lobe_flags INTERFACE --coverage)
endif()

function(lobe_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;USES;PRIVATE_USES" ${ARGN})
  add_library(lobe_${name} STATIC ${ROOM_SOURCES})
  target_link_libraries(lobe_${name} PUBLIC lobe_flags ${ROOM_USES} PRIVATE ${ROOM_PRIVATE_USES})
endfunction()

# Sums over a lobe's coefficients vectorise only if the compiler may reorder them;
# results stay the same from run to run of one build. NaN and infinity keep their meaning.
function(lobe_reorder_sums)
  set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS
    "-O3;-fno-math-errno;-fno-trapping-math;-fno-signed-zeros;-fassociative-math")
endfunction()
