/* docs/example/law/voce.c without its tangent: talus takes differences. */
#define talus_law talus_law_that_gives
#include "../../../docs/example/law/voce.c"
#undef talus_law

const TalusLaw *talus_law(void)
{
  static TalusLaw less;
  less = law;
  less.flags &= ~(unsigned)TALUS_LAW_TANGENT;
  return &less;
}
