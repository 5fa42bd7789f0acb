/* ----------------------------------------------------------------------
   Package DUST: dust detachment from impacting carriers. GPL-2.0, as LAMMPS.

   dust_styles.so registers the package's styles, and the granular styles compiled with our sub-models, in a host
   that dustplugin.so has found to be the LAMMPS it was compiled for.

   Styles are taken from their headers, as LAMMPS does it: the build lists the headers of each kind in
   dust_style_KIND.h, and nothing here changes when one is added.
------------------------------------------------------------------------- */

#include "dust_style_command.h"
#include "dust_style_compute.h"
#include "dust_style_fix.h"
#include "dust_style_pair.h"

#include "comm.h"
#include "error.h"
#include "fix.h"
#include "force.h"
#include "input.h"
#include "lammps.h"
#include "modify.h"
#include "pair.h"
#include "plugin.h"
#include "version.h"

#include <dlfcn.h>
#include <map>
#include <set>
#include <string>
#include <typeinfo>

using namespace LAMMPS_NS;

namespace {

template <class Style> void *create(void *lmp) { return new Style((LAMMPS *)lmp); }

template <class Style> void *create_with_args(void *lmp, int narg, char **arg)
{
  return new Style((LAMMPS *)lmp, narg, arg);
}

// LAMMPS keeps the pointers that it is given for as long as the process lives
const char *remember(const std::string &text)
{
  static std::set<std::string> texts;
  return texts.insert(text).first->c_str();
}

class Registry {
 public:
  Registry(LAMMPS *_lmp, void *_handle, lammpsplugin_regfunc _regfunc) : lmp(_lmp), handle(_handle), regfunc(_regfunc)
  {
  }

  // styles made from the LAMMPS instance alone: pair, command
  template <class Creator>
  void add(const char *style, const char *name, lammpsplugin_factory1 *create, std::map<std::string, Creator> *map)
  {
    lammpsplugin_t plugin = {};
    plugin.creator.v1 = create;
    publish(plugin, style, name, (Creator)create, map);
  }

  // styles made from the arguments of their command too: fix, compute
  template <class Creator>
  void add(const char *style, const char *name, lammpsplugin_factory2 *create, std::map<std::string, Creator> *map)
  {
    lammpsplugin_t plugin = {};
    plugin.creator.v2 = create;
    publish(plugin, style, name, (Creator)create, map);
  }

  // Styles of these names that a deck has made before: they are the host's and know no sub-model of ours. LAMMPS' own
  // message would be that a model is illegal.
  void warn_of_earlier_styles() const
  {
    std::string earlier;
    const auto look = [&](const std::string &what, const std::type_info &type) {
      if (module_of(&type) != module_of(&typeid(Registry))) earlier += (earlier.empty() ? "" : ", ") + what;
    };
    for (const std::string &style : registered) {
      const std::string name = style.substr(style.find(' ') + 1);
      if (style != "pair " + name) continue;
      for (int k = 1; const Pair *pair = lmp->force->pair_match(name, 1, k); k++) {
        look("pair_style " + name, typeid(*pair));
        if (pair == lmp->force->pair || pair == lmp->force->pair_match(name, 1, k + 1)) break;
      }
    }
    for (const Fix *fix : lmp->modify->get_fix_list())
      if (registered.count(std::string("fix ") + fix->style))
        look(std::string("fix ") + fix->id + " (" + fix->style + ")", typeid(*fix));
    if (earlier.empty() || lmp->comm->me != 0) return;
    Error *error = lmp->error;
    error->warning(FLERR,
                   "dustplugin.so was loaded after {}: what was there before knows none of its models, such as "
                   "coeff_restitution/limited. Load it earlier, or now give pair_style none, then pair_style and "
                   "pair_coeff again, and these fixes with the same IDs",
                   earlier);
  }

 private:
  static const void *module_of(const void *address)
  {
    Dl_info info;
    return dladdr(address, &info) ? info.dli_fbase : nullptr;
  }

  // Two lists know a plugin's styles: one for the process (`plugin list`, restored by 4Jul2026 in every new instance
  // and after `clear`) and the map of each instance, which decides what a deck gets. LAMMPS ignores a
  // style that the process knows already, which on 4Feb2025 leaves a second instance without it; so the first is
  // filled once and the second always.
  template <class Creator> void publish(lammpsplugin_t &plugin, const char *style, const char *name, Creator create,
                                        std::map<std::string, Creator> *map)
  {
    const int index = plugin_find(style, name);
    if (index < 0) {
      plugin.version = LAMMPS_VERSION;
      plugin.style = style;
      plugin.name = name;
      plugin.info = remember(std::string(style) + " style " + name + " of package DUST");
      plugin.author = "the DUST developers";
      plugin.handle = handle;
      map->erase(name);    // the built-in granular styles give way to ours knowingly: no warning
      regfunc(&plugin, lmp);
    } else if (plugin_get_info(index)->creator.v1 != plugin.creator.v1) {
      lmp->error->all(FLERR, "{} style {} is already loaded from another plugin: unload that first", style, name);
    }
    (*map)[name] = create;
    registered.insert(std::string(style) + " " + name);
  }

  LAMMPS *lmp;
  void *handle;
  lammpsplugin_regfunc regfunc;
  std::set<std::string> registered;    // "pair granular"
};

}    // namespace

extern "C" __attribute__((visibility("default"))) void dust_register_styles(void *ptr, void *handle, void *regfunc)
{
  auto *lmp = (LAMMPS *)ptr;
  Registry registry(lmp, handle, (lammpsplugin_regfunc)regfunc);

  // with KIND_CLASS defined, a style header holds its macro alone

#define PAIR_CLASS
#define PairStyle(key, Class) registry.add("pair", #key, create<Class>, lmp->force->pair_map)
#include "dust_style_pair.h"
#undef PAIR_CLASS

#define FIX_CLASS
#define FixStyle(key, Class) registry.add("fix", #key, create_with_args<Class>, lmp->modify->fix_map)
#include "dust_style_fix.h"
#undef FIX_CLASS

#define COMPUTE_CLASS
#define ComputeStyle(key, Class) registry.add("compute", #key, create_with_args<Class>, lmp->modify->compute_map)
#include "dust_style_compute.h"
#undef COMPUTE_CLASS

#define COMMAND_CLASS
#define CommandStyle(key, Class) registry.add("command", #key, create<Class>, lmp->input->command_map)
#include "dust_style_command.h"
#undef COMMAND_CLASS

  registry.warn_of_earlier_styles();
}
