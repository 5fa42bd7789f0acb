# What belongs to the package DUST, found by LAMMPS' own naming rules: a style is one pair of files called after
# its kind, so a new one is picked up without a word here. Included by our build and by the injected one.

set(DUST_SOURCE_DIR "${CMAKE_CURRENT_LIST_DIR}/../src")
get_filename_component(DUST_SOURCE_DIR "${DUST_SOURCE_DIR}" ABSOLUTE)
file(GLOB DUST_CORE_SOURCES CONFIGURE_DEPENDS "${DUST_SOURCE_DIR}/core/*.cpp")
file(GLOB DUST_STYLE_SOURCES CONFIGURE_DEPENDS "${DUST_SOURCE_DIR}/*.cpp")
set(DUST_WARNINGS -Wall -Wextra -Wshadow)    # .ci/check allows none, of g++ and of clang++
set_source_files_properties(${DUST_CORE_SOURCES} ${DUST_STYLE_SOURCES} PROPERTIES COMPILE_OPTIONS "${DUST_WARNINGS}")
# changes no result, but a square root that may set errno costs a branch, and keeps the compiler from working on several
# grains at once
set_property(SOURCE ${DUST_CORE_SOURCES} APPEND PROPERTY COMPILE_OPTIONS -fno-math-errno -fno-trapping-math)
# Contacts that are computed many at once must have the bits of LAMMPS' own loop, which computes them one by one. So
# both do without the instruction for a product and a sum, which some processors have and compilers use as they like.
set(DUST_CONTRACTION -ffp-contract=off)
set_property(SOURCE ${DUST_CORE_SOURCES} ${DUST_STYLE_SOURCES} APPEND PROPERTY COMPILE_OPTIONS ${DUST_CONTRACTION})
foreach(kind gran_sub_mod pair fix compute command)
  set(pattern ${kind})
  if(kind STREQUAL "command")
    set(pattern create)    # the package's commands: create_dust
  endif()
  file(GLOB DUST_${kind}_HEADERS CONFIGURE_DEPENDS "${DUST_SOURCE_DIR}/${pattern}_*.h")
endforeach()
