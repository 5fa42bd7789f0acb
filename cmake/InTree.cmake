# LAMMPS with the package compiled in: build/bin/lmp-dust and, for the tests, liblammps_dust.so.
#
# LAMMPS' own CMake files configure the untouched tree in a build folder of their own; InjectDust.cmake is
# all that is added, through a hook that CMake offers. Nothing is patched or copied.
#
# Packages and options repeat those of the stock build in cmake/get-lammps, so that both give the same numbers and
# ccache finds nearly every object: the folders differ, the preprocessed sources do not.

include(ExternalProject)

set(in_tree "${CMAKE_BINARY_DIR}/in-tree")
set(options -D CMAKE_BUILD_TYPE=${CMAKE_BUILD_TYPE} -D BUILD_SHARED_LIBS=ON -D BUILD_MPI=ON -D BUILD_OMP=OFF
            -D FFT=FFTW3 -D WITH_JPEG=ON -D WITH_PNG=ON -D WITH_GZIP=OFF -D WITH_FFMPEG=OFF
            -D CMAKE_EXPORT_COMPILE_COMMANDS=ON -D LAMMPS_SIZES=${LAMMPS_SIZES} -D LAMMPS_MACHINE=dust
            -D CMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER} -D Python_EXECUTABLE=/usr/bin/python3)
foreach(package GRANULAR GRANSURF KSPACE PLUGIN GRAPHICS)
  if(IS_DIRECTORY "${LAMMPS_SOURCE_DIR}/src/${package}")    # GRANSURF and GRAPHICS came with 4Jul2026
    list(APPEND options -D PKG_${package}=ON)
  endif()
endforeach()
string(REPLACE ";" "|" launcher "${CMAKE_CXX_COMPILER_LAUNCHER}")

ExternalProject_Add(lammps-in-tree
  SOURCE_DIR "${LAMMPS_SOURCE_DIR}/cmake"
  BINARY_DIR "${in_tree}"
  PREFIX "${CMAKE_BINARY_DIR}/in-tree-steps"
  LIST_SEPARATOR |
  CMAKE_ARGS ${options} "-DCMAKE_CXX_COMPILER_LAUNCHER=${launcher}" "-DCMAKE_C_COMPILER_LAUNCHER=${launcher}"
             "-DCMAKE_PROJECT_lammps_INCLUDE=${CMAKE_CURRENT_LIST_DIR}/InjectDust.cmake"
  BUILD_COMMAND ${CMAKE_COMMAND} --build <BINARY_DIR>
  INSTALL_COMMAND ${CMAKE_COMMAND} -E make_directory "${CMAKE_BINARY_DIR}/bin"
          COMMAND ${CMAKE_COMMAND} -E create_symlink ../in-tree/lmp_dust "${CMAKE_BINARY_DIR}/bin/lmp-dust"
  STEP_TARGETS configure    # .ci/check asks how our files are compiled, without compiling LAMMPS
  BUILD_ALWAYS ON           # the inner build knows best whether a source changed, and asks in a second
  USES_TERMINAL_BUILD ON    # shows its progress, and does not share the cores with ours
  BUILD_BYPRODUCTS "${in_tree}/liblammps_dust.so")

add_library(lammps_dust SHARED IMPORTED)
set_target_properties(lammps_dust PROPERTIES IMPORTED_LOCATION "${in_tree}/liblammps_dust.so")
add_dependencies(lammps_dust lammps-in-tree)
