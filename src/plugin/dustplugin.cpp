/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.

   dustplugin.so, the file that `plugin load` opens. LAMMPS checks nothing when it loads a plugin, and a plugin
   compiled for another version crashes at some later time. So this file looks before anything is touched: it asks
   the host through the C library, whose functions are the same in all versions, and only then opens
   dust_styles.so beside it, which uses LAMMPS' classes.
------------------------------------------------------------------------- */

#include "exceptions.h"
#include "lammpsplugin.h"
#include "library.h"
#include "lmptype.h"

#include <cstring>
#include <dlfcn.h>
#include <string>

namespace {

// 20260704 -> "4 Jul 2026"
std::string date(int version)
{
  static constexpr const char *MONTHS[] = {"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                           "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
  const int month = version / 100 % 100;
  if (month < 1 || month > 12) return std::to_string(version);
  return std::to_string(version % 100) + " " + MONTHS[month - 1] + " " + std::to_string(version / 10000);
}

// in what the host differs from the LAMMPS that this plugin was compiled for; empty if in nothing
std::string difference(void *lmp)
{
  const int version = lammps_version(lmp);
  if (version != DUST_LAMMPS_VERSION)
    return "it was compiled for LAMMPS " + date(DUST_LAMMPS_VERSION) + " and this is LAMMPS " + date(version);

  struct {
    const char *name;
    int size;
  } static constexpr INTEGERS[] = {{"bigint", sizeof(LAMMPS_NS::bigint)},
                                   {"tagint", sizeof(LAMMPS_NS::tagint)},
                                   {"imageint", sizeof(LAMMPS_NS::imageint)}};
  for (const auto &integer : INTEGERS) {
    const int size = lammps_extract_setting(lmp, integer.name);
    if (size != integer.size)
      return "it was compiled for " + std::to_string(8 * integer.size) + "-bit " + integer.name +
             " and this LAMMPS has " + std::to_string(8 * size) + "-bit " + integer.name + " (LAMMPS_SIZES)";
  }
  if (!lammps_config_has_mpi_support()) return "it was compiled with MPI and this LAMMPS without";
  return "";
}

// whether the host has the package compiled in (lmp-dust); what comes from a plugin is in LAMMPS' list of plugins
bool compiled_in(void *lmp)
{
  static constexpr const char *STYLE = "fix", *NAME = "dust/detach";
  if (!lammps_has_style(lmp, STYLE, NAME)) return false;
  char style[64], name[64];
  for (int i = 0; i < lammps_plugin_count(); ++i)
    if (lammps_plugin_name(i, style, name, sizeof(name)) && !strcmp(style, STYLE) && !strcmp(name, NAME)) return false;
  return true;
}

// Ends the deck as LAMMPS' own errors do: one message on screen and in the log, from rank 0, then the exception
// that both `lmp` and the library interface expect. It is thrown from here, and the message printed by a command,
// because calling the host's Error class would need the class layouts that are in doubt.
[[noreturn]] void refuse(void *lmp, const std::string &why)
{
  const std::string message = "ERROR: dustplugin.so is not loaded: " + why;
  lammps_command(lmp, ("print \"\"\"" + message + "\"\"\"").c_str());
  throw LAMMPS_NS::LAMMPSException(message);
}

}    // namespace

// NOLINTNEXTLINE
extern "C" __attribute__((visibility("default"))) void lammpsplugin_init(void *lmp, void *handle, void *regfunc)
{
  const std::string why = difference(lmp);
  if (!why.empty()) refuse(lmp, why + "; build the plugin from the source of this LAMMPS (-D LAMMPS_SOURCE_DIR=...)");

  // so that one deck, with its line `plugin load`, runs on a stock LAMMPS and on lmp-dust
  if (compiled_in(lmp)) {
    lammps_command(lmp, "print 'dustplugin.so is not needed: this LAMMPS has the package DUST compiled in'");
    return;
  }

  // Beside this file, wherever it was installed. Never closed: LAMMPS closes a plugin when the first of several
  // instances is through with it (4Feb2025), while others still use its styles.
  Dl_info self;
  std::string styles = "dust_styles.so";
  if (dladdr(reinterpret_cast<void *>(&lammpsplugin_init), &self)) {
    const std::string path = self.dli_fname;
    const auto slash = path.rfind('/');
    styles = (slash == std::string::npos ? "./" : path.substr(0, slash + 1)) + styles;
  }
  void *module = dlopen(styles.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!module) refuse(lmp, std::string("cannot open its second file: ") + dlerror());
  using registration = void (*)(void *, void *, void *);
  reinterpret_cast<registration>(dlsym(module, "dust_register_styles"))(lmp, handle, regfunc);
}
