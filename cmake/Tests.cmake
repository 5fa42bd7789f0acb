# One program for each file test_*.cpp of unittest/core (no LAMMPS) and unittest/styles (a LAMMPS instance: lmp-dust as
# a library), and the fronts with which unittest/plugin shows that a plugin made for another LAMMPS is refused. What
# drives programs from outside (unittest/{plugin,decks,mpi}, python/tests) is pytest's, run by ./bootstrap test.
#
# All of them are built by the target `tests` and by nothing else: whoever builds the package does not depend on them.

find_package(GTest QUIET)
if(NOT GTest_FOUND)
  message(FATAL_ERROR "GoogleTest is not installed: apt-get install libgtest-dev, or -D DUST_TESTS=OFF")
endif()
include(GoogleTest)
add_custom_target(tests)

# a file with a main() of its own keeps that
function(add_gtest folder file)
  get_filename_component(name "${file}" NAME_WE)
  set(target "${folder}_${name}")
  add_executable(${target} EXCLUDE_FROM_ALL "${file}")
  add_dependencies(tests ${target})
  # they compare bits of what they compute themselves, too
  target_compile_options(${target} PRIVATE ${DUST_WARNINGS} ${DUST_CONTRACTION})
  target_link_libraries(${target} PRIVATE ${ARGN} GTest::gtest_main)
  target_include_directories(${target} PRIVATE src src/core unittest unittest/${folder})
  target_compile_definitions(${target} PRIVATE DUST_INPUTS_DIR="${CMAKE_SOURCE_DIR}/lammps-inputs"
                             DUST_TEST_DIR="${CMAKE_SOURCE_DIR}/unittest/${folder}")
  set_target_properties(${target} PROPERTIES RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/unittest")
  # asked for its tests when ctest starts, not when it is built: some start MPI. A test with Speed in its name measures
  # time and gets the machine to itself.
  set(common TEST_PREFIX "${folder}/" DISCOVERY_MODE PRE_TEST WORKING_DIRECTORY "${CMAKE_BINARY_DIR}/unittest")
  gtest_discover_tests(${target} ${common} TEST_FILTER "-*Speed*" PROPERTIES TIMEOUT 300)
  gtest_discover_tests(${target} ${common} TEST_FILTER "*Speed*" PROPERTIES TIMEOUT 300 RUN_SERIAL TRUE)
endfunction()

file(GLOB core_tests CONFIGURE_DEPENDS unittest/core/test_*.cpp)
foreach(file ${core_tests})
  add_gtest(core "${file}" dust_core)
endforeach()

if(DUST_IN_TREE)
  # the library's own copy of src/core serves: a second one beside it could hide an error in either
  file(GLOB style_tests CONFIGURE_DEPENDS unittest/styles/test_*.cpp)
  foreach(file ${style_tests})
    add_gtest(styles "${file}" lammps_dust lammps_headers MPI::MPI_CXX)
    get_filename_component(name "${file}" NAME_WE)
    target_compile_definitions(styles_${name} PRIVATE LAMMPS_${DUST_SIZES}
                               LAMMPS_VERSION_NUMBER=${LAMMPS_VERSION_NUMBER})
  endforeach()
endif()

if(DUST_PLUGIN)
  if(DUST_SIZES STREQUAL "BIGBIG")
    set(other_sizes SMALLBIG)
  else()
    set(other_sizes BIGBIG)
  endif()
  add_front(other_sizes DUST_LAMMPS_VERSION=${LAMMPS_VERSION_NUMBER} LAMMPS_${other_sizes})
  add_front(other_version DUST_LAMMPS_VERSION=20240829 LAMMPS_${DUST_SIZES})
  set_target_properties(other_sizes other_version PROPERTIES EXCLUDE_FROM_ALL ON
                        LIBRARY_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/unittest")
  add_dependencies(tests other_sizes other_version)
endif()
