/* A subroutine UMAT as gfortran would compile it: linear elasticity, PROPS = E, nu; STATEV(1) counts the calls that
 * reached this state, STATEV(2) to (4) are COORDS if there is room. With ENDS it ends the process in the call behind so
 * many, as STOP does. */
#include <stddef.h>
#include <stdlib.h>
#define FORTRAN const void *

void umat_(double *stress, double *statev, double *ddsdde, FORTRAN sse, FORTRAN spd, FORTRAN scd, FORTRAN rpl,
           FORTRAN ddsddt, FORTRAN drplde, FORTRAN drpldt, FORTRAN stran, const double *dstran, FORTRAN time,
           FORTRAN dtime, FORTRAN temp, FORTRAN dtemp, FORTRAN predef, FORTRAN dpred, FORTRAN cmname, const int *ndi,
           const int *nshr, const int *ntens, const int *nstatv, const double *props, const int *nprops,
           const double *coords)
{
  const double lambda = props[0] * props[1] / ((1 + props[1]) * (1 - 2 * props[1])),
               mu = props[0] / (2 * (1 + props[1]));
  (void)sse, (void)spd, (void)scd, (void)rpl, (void)ddsddt, (void)drplde, (void)drpldt, (void)stran, (void)time;
  (void)dtime, (void)temp, (void)dtemp, (void)predef, (void)dpred, (void)cmname, (void)nshr, (void)nprops;
  for (int i = 0; i < *ntens; ++i)
    for (int j = 0; j < *ntens; ++j) {
      const double d = (i < *ndi && j < *ndi ? lambda : 0) + (i == j ? (i < *ndi ? 2 : 1) * mu : 0);
      ddsdde[*ntens * j + i] = d;
      stress[i] += d * dstran[j];
    }
  if (*nstatv > 0) statev[0] += 1;
  for (int d = 0; d < 3 && *nstatv > 3; ++d) statev[1 + d] = coords[d];
#ifdef ENDS
  static int calls;
  if (++calls > ENDS) exit(0);
#endif
}
