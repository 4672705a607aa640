/* Triangles written to files of a folder that goes at the end. */
#pragma once
#include <string.h>
#include <unistd.h>
#include "walls.h"

#define MOST_TRIANGLES 200000

typedef struct {
  int n;
  double (*corner)[3][3];
} Soup;

static char folder[64] = "/tmp/talus_wall_XXXXXX";

static inline int make_folder(void **state)
{
  (void)state;
  return mkdtemp(folder) ? 0 : 1;
}

static inline int remove_folder(void **state)
{
  char command[128];
  (void)state;
  snprintf(command, sizeof command, "rm -r %s", folder);
  return system(command);
}

static inline void soup_open(Soup *s) { *s = (Soup){0, malloc(MOST_TRIANGLES * sizeof *s->corner)}; }
static inline void soup_close(Soup *s) { free(s->corner); }

static inline void soup_add(Soup *s, const double *a, const double *b, const double *c)
{
  const double *from[3] = {a, b, c};
  for (int k = 0; k < 3; ++k) memcpy(s->corner[s->n][k], from[k], 3 * sizeof(double));
  ++s->n;
}

/* a b c d in their order: two triangles. */
static inline void soup_add_quad(Soup *s, const double *a, const double *b, const double *c, const double *d)
{
  soup_add(s, a, b, c);
  soup_add(s, a, c, d);
}

static inline void soup_add_box(Soup *s, const double min[3], const double max[3])
{
  double v[8][3];
  static const int faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (int k = 0; k < 8; ++k)
    for (int d = 0; d < 3; ++d) v[k][d] = k >> d & 1 ? max[d] : min[d];
  for (int f = 0; f < 6; ++f) soup_add_quad(s, v[faces[f][0]], v[faces[f][1]], v[faces[f][2]], v[faces[f][3]]);
}

/* An octahedron, whose triangles are cut in four so many times and blown up to a sphere. */
static inline void soup_add_sphere(Soup *s, const double centre[3], double radius, int cuts)
{
  const int n = 1 << cuts;
  for (int octant = 0; octant < 8; ++octant)
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n - i; ++j)
        for (int up = 0; up < 2 - (i + j == n - 1); ++up) {
          const int place[2][3][2] = {{{i, j}, {i + 1, j}, {i, j + 1}}, {{i + 1, j}, {i + 1, j + 1}, {i, j + 1}}};
          double v[3][3];
          for (int k = 0; k < 3; ++k) {
            const int a = place[up][k][0], b = place[up][k][1], c = n - a - b;
            const double x[3] = {a, b, c}, length = sqrt(a * a + b * b + c * c);
            for (int d = 0; d < 3; ++d) v[k][d] = centre[d] + (octant >> d & 1 ? -1 : 1) * radius * x[d] / length;
          }
          const int odd = (octant & 1) ^ (octant >> 1 & 1) ^ (octant >> 2 & 1);
          soup_add(s, v[0], v[odd ? 2 : 1], v[odd ? 1 : 2]);
        }
}

static inline const char *soup_path(const char *name)
{
  static char path[128];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  return path;
}

static inline const char *write_binary(const Soup *s, const char *name)
{
  const char *path = soup_path(name);
  char head[80] = "solid is how some programs begin binary files, too";
  FILE *out = fopen(path, "wb");
  const uint32_t n = (uint32_t)s->n;
  fwrite(head, sizeof head, 1, out);
  fwrite(&n, sizeof n, 1, out);
  for (int i = 0; i < s->n; ++i) {
    float value[12] = {0};
    const uint16_t none = 0;
    for (int k = 0; k < 9; ++k) value[3 + k] = (float)s->corner[i][k / 3][k % 3];
    fwrite(value, sizeof value, 1, out);
    fwrite(&none, sizeof none, 1, out);
  }
  fclose(out);
  return path;
}

static inline const char *write_ascii(const Soup *s, const char *name)
{
  const char *path = soup_path(name);
  FILE *out = fopen(path, "w");
  fprintf(out, "solid a vertex of 1 2 3\n");
  for (int i = 0; i < s->n; ++i) {
    fprintf(out, "  facet normal 0 0 0\n    outer loop\n");
    for (int k = 0; k < 3; ++k)
      fprintf(out, "      vertex %.17g %.17e %.17g\n", s->corner[i][k][0], s->corner[i][k][1], s->corner[i][k][2]);
    fprintf(out, "    endloop\n  ENDFACET\n");
  }
  fprintf(out, "endsolid\n");
  fclose(out);
  return path;
}

/* A .msh 2.2 of triangles; those from `first` on are the physical surface "lid", the others
 * "rest". */
static inline const char *write_msh(const Soup *s, int first, const char *name)
{
  const char *path = soup_path(name);
  FILE *out = fopen(path, "w");
  fprintf(out,
          "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 1 \"rest\"\n2 2 \"lid\"\n$EndPhysicalNames\n");
  fprintf(out, "$Nodes\n%d\n", 3 * s->n);
  for (int i = 0; i < 3 * s->n; ++i)
    fprintf(out, "%d %.17g %.17g %.17g\n", i + 1, s->corner[i / 3][i % 3][0], s->corner[i / 3][i % 3][1],
            s->corner[i / 3][i % 3][2]);
  fprintf(out, "$EndNodes\n$Elements\n%d\n", s->n);
  for (int i = 0; i < s->n; ++i)
    fprintf(out, "%d 2 2 %d %d %d %d %d\n", i + 1, i < first ? 1 : 2, i < first ? 1 : 2, 3 * i + 1, 3 * i + 2,
            3 * i + 3);
  fprintf(out, "$EndElements\n");
  fclose(out);
  return path;
}

static inline WallSpec surface_of(const char *path)
{
  return (WallSpec){.shape = {.kind = SHAPE_SURFACE, .file = (char *)path, .scale = 1}};
}
