# The plugin for a stock LAMMPS: two files in build/plugin that belong together.
#
#   dustplugin.so     what the user loads. Uses LAMMPS' C library alone, so that any LAMMPS can open it; compares
#                     versions and refuses in words, or opens
#   dust_styles.so    our styles and, compiled a second time from the user's own unmodified sources, the granular styles
#                     whose table of sub-models is fixed at compile time.
#
# In one file, the dynamic linker would meet the symbols that another LAMMPS version lacks before any code of ours
# runs, and its message names a mangled symbol instead of the cause. The second name does not end in plugin.so because
# LAMMPS loads every such file in LAMMPS_PLUGIN_PATH.

set(plugin_dir "${CMAKE_BINARY_DIR}/plugin")
set(exports "${CMAKE_CURRENT_LIST_DIR}/exports.map")

# add_plugin_module(TARGET SOURCES...)
# Our copies of the granular classes must neither replace the host's nor be replaced by them: all but one entry
# point is hidden, and calls between our own functions are bound when linking. The host's symbols stay open.
function(add_plugin_module target)
  add_library(${target} MODULE ${ARGN})
  target_link_libraries(${target} PRIVATE lammps_headers ${CMAKE_DL_LIBS})
  target_link_options(${target} PRIVATE -Wl,-Bsymbolic "-Wl,--version-script=${exports}")
  set_target_properties(${target} PROPERTIES PREFIX "" SUFFIX ".so" LIBRARY_OUTPUT_DIRECTORY "${plugin_dir}"
                        CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON LINK_DEPENDS "${exports}")
endfunction()

# add_front(TARGET definitions...): tests build fronts that claim another version or other integer sizes
function(add_front target)
  add_plugin_module(${target} "${DUST_SOURCE_DIR}/plugin/dustplugin.cpp")
  target_compile_definitions(${target} PRIVATE ${ARGN})
  target_compile_options(${target} PRIVATE ${DUST_WARNINGS})
endfunction()
add_front(dustplugin DUST_LAMMPS_VERSION=${LAMMPS_VERSION_NUMBER} LAMMPS_${DUST_SIZES})

# write_includes(FILE HEADERS...): a list of style headers, in the form that LAMMPS' own build generates
function(write_includes file)
  set(includes "")
  foreach(header ${ARGN})
    get_filename_component(name "${header}" NAME)
    string(APPEND includes "#include \"${name}\"\n")
  endforeach()
  file(CONFIGURE OUTPUT "${CMAKE_BINARY_DIR}/styles/${file}" CONTENT "${includes}" @ONLY)
endfunction()

# The user's granular sources with a table of sub-models that also lists ours. GRANULAR/MDR comes along because
# it looks for the pair and wall styles by class.
set(granular_dir "${LAMMPS_SOURCE_DIR}/src/GRANULAR")
set(granular_pairs pair_granular)
set(granular_fixes fix_wall_gran fix_wall_gran_region fix_granular_mdr)
file(GLOB granular CONFIGURE_DEPENDS "${granular_dir}/gran_sub_mod*.cpp")
foreach(name granular_model ${granular_pairs} ${granular_fixes})
  list(APPEND granular "${granular_dir}/${name}.cpp")
endforeach()
set_property(SOURCE ${granular} APPEND PROPERTY COMPILE_OPTIONS ${DUST_CONTRACTION})
file(GLOB sub_models CONFIGURE_DEPENDS "${granular_dir}/gran_sub_mod_*.h")

# surfaces of triangles (STL files), since 4Jul2026: what they use beyond this is in LAMMPS' core, so that the host
# needs no GRANSURF
set(surface_dir "${LAMMPS_SOURCE_DIR}/src/GRANSURF")
if(IS_DIRECTORY "${surface_dir}")
  foreach(name surf_extra fix_surface pair_surf_granular fix_surface_global fix_surface_local)
    list(APPEND granular "${surface_dir}/${name}.cpp")
  endforeach()
  list(APPEND granular_pairs pair_surf_granular)
  list(APPEND granular_fixes fix_surface_global fix_surface_local)
  target_include_directories(lammps_headers SYSTEM INTERFACE "${surface_dir}")
endif()
# ours, children of them, have their names
list(REMOVE_ITEM granular_pairs pair_granular)
list(REMOVE_ITEM granular_fixes fix_wall_gran fix_wall_gran_region)
list(TRANSFORM granular_pairs APPEND .h)
list(TRANSFORM granular_fixes APPEND .h)

write_includes(style_gran_sub_mod.h ${sub_models} ${DUST_gran_sub_mod_HEADERS})
write_includes(dust_style_pair.h ${granular_pairs} ${DUST_pair_HEADERS})
write_includes(dust_style_fix.h ${granular_fixes} ${DUST_fix_HEADERS})
write_includes(dust_style_compute.h ${DUST_compute_HEADERS})
write_includes(dust_style_command.h ${DUST_command_HEADERS})

add_plugin_module(dust_styles "${DUST_SOURCE_DIR}/plugin/styles.cpp" ${DUST_STYLE_SOURCES} ${granular})
set_source_files_properties("${DUST_SOURCE_DIR}/plugin/styles.cpp" PROPERTIES COMPILE_OPTIONS "${DUST_WARNINGS}")
target_include_directories(dust_styles BEFORE PRIVATE "${CMAKE_BINARY_DIR}/styles" "${DUST_SOURCE_DIR}")
target_compile_definitions(dust_styles PRIVATE LAMMPS_${DUST_SIZES})
target_link_libraries(dust_styles PRIVATE dust_core)
add_dependencies(dustplugin dust_styles)    # building what the user loads builds both
