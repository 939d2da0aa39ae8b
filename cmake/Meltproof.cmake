# SPDX-License-Identifier: GPL-3.0-or-later
# What every target of the suite shares, and the functions with which a module declares its parts.
find_package(OpenMP REQUIRED COMPONENTS CXX)
find_package(PkgConfig REQUIRED)
find_package(spdlog REQUIRED)
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(OpenSSL REQUIRED COMPONENTS Crypto)
find_package(GTest REQUIRED)
find_package(Eigen3 REQUIRED)
find_package(GSL REQUIRED)
pkg_check_modules(HDF5_SERIAL REQUIRED IMPORTED_TARGET hdf5-serial)
pkg_check_modules(HDF5_OPENMPI REQUIRED IMPORTED_TARGET hdf5-openmpi)
find_package(MPI REQUIRED COMPONENTS CXX)
find_path(ZOLTAN_INCLUDE_DIR zoltan.h PATH_SUFFIXES trilinos REQUIRED)
find_library(ZOLTAN_LIBRARY trilinos_zoltan REQUIRED)
find_path(UDUNITS2_INCLUDE_DIR udunits2.h REQUIRED)
find_library(UDUNITS2_LIBRARY udunits2 REQUIRED)

add_library(meltproof_options INTERFACE)
target_include_directories(meltproof_options INTERFACE ${CMAKE_SOURCE_DIR})
target_compile_options(meltproof_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wold-style-cast -Wcast-qual -Woverloaded-virtual -Werror
  # Sums must not be reordered and NaN must stay testable: never -ffast-math. Contraction is left off
  # so that a scalar and a SIMD build of one pair function round alike.
  -ffp-contract=off -fno-math-errno -fno-trapping-math)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # GCC 12 warns of the deliberately undefined lanes inside its own AVX-512 intrinsics, and of overlaps in
  # std::string that cannot happen. Known false alarms of that version.
  target_compile_options(meltproof_options INTERFACE -Wno-maybe-uninitialized -Wno-uninitialized -Wno-restrict)
endif()
if(MELTPROOF_NATIVE)
  target_compile_options(meltproof_options INTERFACE -march=native)
endif()
if(MELTPROOF_SANITIZE)
  target_compile_options(meltproof_options INTERFACE -fsanitize=address,undefined -fno-omit-frame-pointer)
  target_link_options(meltproof_options INTERFACE -fsanitize=address,undefined)
endif()

# meltproof_library(name SOURCES a.cpp ... LIBRARIES b ...): a static library of a module.
function(meltproof_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBRARIES" ${ARGN})
  add_library(${name} STATIC ${ARG_SOURCES})
  target_link_libraries(${name} PUBLIC meltproof_options ${ARG_LIBRARIES})
endfunction()

# Which of the two bases programs link, see base/CMakeLists.txt; the solver's folder sets the other.
set(MELTPROOF_BASE meltproof_base)

# meltproof_program(name SOURCES main.cpp LIBRARIES ...): a command-line tool of the suite.
function(meltproof_program name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBRARIES" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE meltproof_options ${MELTPROOF_BASE} ${ARG_LIBRARIES})
endfunction()

# meltproof_test(name SOURCES x_test.cpp ... LIBRARIES ... [LABELS ...] [TIMEOUT s]): one GoogleTest
# program as one CTest test. The project's root is its working directory, so tests read data/ directly
# and the vendors' sample files at ../shared/samples.
function(meltproof_test name)
  cmake_parse_arguments(ARG "" "TIMEOUT" "SOURCES;LIBRARIES;LABELS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE meltproof_options ${ARG_LIBRARIES} GTest::gtest_main)
  add_test(NAME ${name} COMMAND ${name} WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 300)
  endif()
  # A folder of its own for what the test writes: tests run side by side, and two may like the same file name.
  set(scratch ${CMAKE_BINARY_DIR}/scratch/${name})
  file(MAKE_DIRECTORY ${scratch})
  set_tests_properties(${name} PROPERTIES LABELS "${ARG_LABELS}" TIMEOUT ${ARG_TIMEOUT}
    ENVIRONMENT "TEST_TMPDIR=${scratch}")
endfunction()
