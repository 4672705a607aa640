/* A subroutine UMAT: von Mises with linear hardening, radial return; PROPS = E, nu, yield stress, H; STATEV(1) is the
 * plastic strain. DDSDDE is consistent (Simo and Hughes, box 3.2). */
#include <math.h>
#define FORTRAN const void *

void umat_(double *stress, double *statev, double *ddsdde, FORTRAN sse, FORTRAN spd, FORTRAN scd, FORTRAN rpl,
           FORTRAN ddsddt, FORTRAN drplde, FORTRAN drpldt, FORTRAN stran, const double *dstran, FORTRAN time,
           FORTRAN dtime, FORTRAN temp, FORTRAN dtemp, FORTRAN predef, FORTRAN dpred, FORTRAN cmname, const int *ndi,
           const int *nshr, const int *ntens, const int *nstatv, const double *props, const int *nprops)
{
  const double mu = props[0] / (2 * (1 + props[1])), bulk = props[0] / (3 * (1 - 2 * props[1])), H = props[3];
  double n[6], norm = 0, f = 1, g = 0;
  (void)sse, (void)spd, (void)scd, (void)rpl, (void)ddsddt, (void)drplde, (void)drpldt, (void)stran, (void)time;
  (void)dtime, (void)temp, (void)dtemp, (void)predef, (void)dpred, (void)cmname, (void)nshr, (void)nprops, (void)nstatv;
  (void)ntens, (void)ndi;
  const double trace = dstran[0] + dstran[1] + dstran[2];
  for (int i = 0; i < 6; ++i)
    stress[i] += (i < 3 ? 2 : 1) * mu * dstran[i] + (i < 3 ? (bulk - 2.0 / 3.0 * mu) * trace : 0);
  const double mean = (stress[0] + stress[1] + stress[2]) / 3;
  for (int i = 0; i < 6; ++i) {
    n[i] = stress[i] - (i < 3 ? mean : 0);
    norm += (i < 3 ? 1 : 2) * n[i] * n[i];
  }
  norm = sqrt(norm);
  for (int i = 0; i < 6; ++i) n[i] = norm > 0 ? n[i] / norm : 0;
  const double over = sqrt(1.5) * norm - (props[2] + H * statev[0]);
  if (over > 1e-14 * props[2]) {
    const double d = over / (3 * mu + H);
    statev[0] += d;
    for (int i = 0; i < 6; ++i) stress[i] -= sqrt(6.0) * mu * d * n[i];
    f = 1 - sqrt(6.0) * mu * d / norm;
    g = 2 * mu * (1 - f - 3 * mu / (3 * mu + H));
  }
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      ddsdde[6 * j + i] =
        (i < 3 && j < 3 ? bulk - 2.0 / 3.0 * mu * f : 0) + (i == j ? (i < 3 ? 2 : 1) * mu * f : 0) + g * n[i] * n[j];
}
