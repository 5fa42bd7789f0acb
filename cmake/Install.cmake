# cmake --install build --prefix PREFIX. LAMMPS has no fixed place for plugins: it loads every *plugin.so in the folders
# of LAMMPS_PLUGIN_PATH. So PREFIX gets
#
#   lib/lammps/plugins/             dustplugin.so and dust_styles.so, which it opens beside itself; libdustcore.so
#   share/dustdetach/lammps-inputs  the decks
#   lib/pythonX.Y/site-packages/    the Python package: found by a Python of that prefix, a virtual environment for one
#   bin/dustdetach                  its command, which finds all three by its own place
#   etc/profile.d/dust.sh           sets LAMMPS_PLUGIN_PATH and PYTHONPATH at login, beside LAMMPS' own lammps.sh

include(GNUInstallDirs)
set(plugins "lib/lammps/plugins")
set(inputs "${CMAKE_INSTALL_DATADIR}/dustdetach/lammps-inputs")
find_package(Python3 QUIET COMPONENTS Interpreter)
set(DUST_PYTHON_DIR "lib/python${Python3_VERSION_MAJOR}.${Python3_VERSION_MINOR}/site-packages" CACHE STRING
    "Where the Python package is installed, below the prefix")

if(DUST_PLUGIN)
  install(TARGETS dustplugin dust_styles LIBRARY DESTINATION "${plugins}")
endif()
install(TARGETS dustcore LIBRARY DESTINATION "${plugins}")
install(DIRECTORY lammps-inputs/ DESTINATION "${inputs}")
install(DIRECTORY python/src/dustdetach DESTINATION "${DUST_PYTHON_DIR}" PATTERN __pycache__ EXCLUDE)

file(CONFIGURE OUTPUT dustdetach @ONLY CONTENT [[#!/bin/sh
# dustdetach, the command of the Python package installed with the LAMMPS package DUST
prefix=$(cd "$(dirname "$(readlink -f "$0")")/.." && pwd)
export DUSTDETACH_PLUGIN="${DUSTDETACH_PLUGIN:-$prefix/@plugins@/dustplugin.so}"
export DUSTDETACH_INPUTS="${DUSTDETACH_INPUTS:-$prefix/@inputs@}"
export PYTHONPATH="$prefix/@DUST_PYTHON_DIR@${PYTHONPATH:+:$PYTHONPATH}"
exec python3 -m dustdetach "$@"
]])
install(PROGRAMS "${CMAKE_CURRENT_BINARY_DIR}/dustdetach" DESTINATION "${CMAKE_INSTALL_BINDIR}")

# the prefix is known for certain when installing, not before
install(CODE "set(plugins \"${plugins}\")\nset(site \"${DUST_PYTHON_DIR}\")")
install(CODE [[
  file(WRITE "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/etc/profile.d/dust.sh"
"# the LAMMPS package DUST: lets LAMMPS load the plugin at start and Python find the package dustdetach
LAMMPS_PLUGIN_PATH=\"${CMAKE_INSTALL_PREFIX}/${plugins}\${LAMMPS_PLUGIN_PATH:+:\$LAMMPS_PLUGIN_PATH}\"
PYTHONPATH=\"${CMAKE_INSTALL_PREFIX}/${site}\${PYTHONPATH:+:\$PYTHONPATH}\"
export LAMMPS_PLUGIN_PATH PYTHONPATH
")]])
