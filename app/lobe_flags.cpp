#include "app/lobe_flags.h"

#include "app/commands.h"

namespace lobe {

void LobeFlags::AddTo(CLI::App* command) {
  command->add_option("--lmax", l_max, "Cap on the degree of a lobe, 0 to 32")
      ->type_name("N")
      ->capture_default_str();
  command
      ->add_option("--lobe-error", error_percent,
                   "Error a gloss lobe may have, percent of its flux; the lowest degree within it is taken")
      ->type_name("PCT")
      ->capture_default_str();
  command
      ->add_option("--force-lmax", force_l_max,
                   "Give every gloss lobe exactly this degree, 0 to 32 [chosen by --lobe-error]")
      ->type_name("N");
}

LobeOptions LobeFlags::Options() const {
  LobeOptions options;
  options.l_max = l_max;
  options.error = error_percent / 100;
  if (force_l_max) {
    // -1 means "not forced" inside, and must not be reached from outside.
    if (*force_l_max < 0) {
      throw UsageError("forced lmax " + std::to_string(*force_l_max) +
                       " is out of range: 0 to 32 is expected");
    }
    options.force_l_max = *force_l_max;
  }
  return options;
}

}  // namespace lobe
