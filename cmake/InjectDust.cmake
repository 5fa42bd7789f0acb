# Read by LAMMPS' own CMakeLists.txt right after its project() call (CMAKE_PROJECT_lammps_INCLUDE): adds the
# package DUST to the target `lammps` as if it lay in src/DUST.

include("${CMAKE_CURRENT_LIST_DIR}/Sources.cmake")

# LAMMPS collects style headers in global lists, to which RegisterStyles() appends; ours are in them from the start. It
# sorts them by name, and of two styles of one name the last one counts: pair_granular_fused.h comes after
# pair_granular.h.
foreach(kind gran_sub_mod pair fix compute command)
  string(TOUPPER ${kind} list)
  set_property(GLOBAL APPEND PROPERTY ${list} ${DUST_${kind}_HEADERS})
endforeach()

# the target does not exist yet: wait for the end of LAMMPS' CMakeLists.txt
function(add_dust_to_lammps)
  target_sources(lammps PRIVATE ${DUST_STYLE_SOURCES} ${DUST_CORE_SOURCES})
  target_include_directories(lammps PRIVATE ${DUST_SOURCE_DIR})
  # our warnings are about our files, not about the headers of LAMMPS that they include
  set_property(SOURCE ${DUST_STYLE_SOURCES} APPEND PROPERTY
               COMPILE_OPTIONS "-isystem${LAMMPS_SOURCE_DIR}" "-isystem${LAMMPS_SOURCE_DIR}/GRANULAR")
  file(GLOB granular "${LAMMPS_SOURCE_DIR}/GRANULAR/gran*.cpp" "${LAMMPS_SOURCE_DIR}/GRANULAR/pair_granular.cpp")
  set_property(SOURCE ${granular} APPEND PROPERTY COMPILE_OPTIONS ${DUST_CONTRACTION})
  if(PKG_GRANSURF)
    set_property(SOURCE ${DUST_STYLE_SOURCES} APPEND PROPERTY COMPILE_OPTIONS "-isystem${LAMMPS_SOURCE_DIR}/GRANSURF")
  endif()
endfunction()
cmake_language(DEFER CALL add_dust_to_lammps)
