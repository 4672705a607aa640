/* Meshes as Gmsh's version 2.2 in ASCII. */
#include <string.h>
#include "import/kratos/project.h"

/* Gmsh's number of an element with so many nodes in so many dimensions; 0: none. */
static int msh_type(PetscInt n, PetscInt dim)
{
  if (dim == 0) return 15;
  if (dim == 1) return n == 2 ? 1 : 0;
  if (dim == 2) return n == 3 ? 2 : n == 4 ? 3 : 0;
  return n == 4 ? 4 : n == 8 ? 5 : 0;
}

static void write_nodes(FILE *out, const Mdpa *m)
{
  fprintf(out, "$Nodes\n%" PetscInt_FMT "\n", m->n_nodes);
  for (PetscInt i = 0; i < m->n_nodes; ++i)
    fprintf(out, "%" PetscInt_FMT " %.17g %.17g %.17g\n", m->node_id[i], (double)m->x[i][0], (double)m->x[i][1],
            (double)m->x[i][2]);
  fputs("$EndNodes\n", out);
}

static void write_element(FILE *out, PetscInt number, int type, PetscInt group, const Mdpa *m, PetscInt n,
                          const PetscInt *node)
{
  fprintf(out, "%" PetscInt_FMT " %d 2 %" PetscInt_FMT " %" PetscInt_FMT, number, type, group, group);
  for (PetscInt i = 0; i < n; ++i) fprintf(out, " %" PetscInt_FMT, m->node_id[node[i]]);
  fputc('\n', out);
}

/* Counted first (out NULL), then written: the format wants the number before. */
static PetscInt write_cells(FILE *out, const Mdpa *m, const MdpaIds *ids, PetscInt group, PetscInt dim, PetscInt number)
{
  for (PetscInt k = 0; k < (ids ? ids->n : m->elements.n); ++k) {
    const PetscInt e = ids ? mdpa_find(&m->elements, ids->id[k]) : k;
    if (e < 0) continue;
    const MdpaEntity *cell = &m->elements.entity[e];
    ++number;
    if (out) write_element(out, number, msh_type(cell->n, dim), group, m, cell->n, cell->node);
  }
  return number;
}

/* The nodes of a part as points, and its conditions as lines or faces. */
static PetscInt write_part(FILE *out, const Mdpa *m, const MdpaPart *part, PetscInt group, PetscInt dim,
                           PetscInt number)
{
  for (PetscInt k = 0; k < part->nodes.n; ++k) {
    const PetscInt node = mdpa_node(m, part->nodes.id[k]);
    if (node < 0) continue;
    ++number;
    if (out) write_element(out, number, 15, group, m, 1, &node);
  }
  for (PetscInt k = 0; k < part->conditions.n; ++k) {
    const PetscInt c = mdpa_find(&m->conditions, part->conditions.id[k]);
    if (c < 0 || m->conditions.entity[c].n < 2) continue;
    ++number;
    if (out)
      write_element(out, number, msh_type(m->conditions.entity[c].n, dim - 1), group, m, m->conditions.entity[c].n,
                    m->conditions.entity[c].node);
  }
  return number;
}

/* Is this the first action at its part? Parts are written once. */
static PetscBool first_of_part(const KratosProject *p, PetscInt a)
{
  for (PetscInt b = 0; b < a; ++b)
    if (!strcmp(p->actions[b].part, p->actions[a].part)) return PETSC_FALSE;
  return PETSC_TRUE;
}

static PetscInt write_grid_elements(FILE *out, const KratosProject *p)
{
  PetscInt number = write_cells(out, p->grid, NULL, 1, p->dim, 0);
  for (PetscInt a = 0; a < p->n_actions; ++a)
    if (first_of_part(p, a))
      number = write_part(out, p->grid, mdpa_part(p->grid, p->actions[a].part), a + 2, p->dim, number);
  return number;
}

static PetscErrorCode Open(const char *file, FILE **out)
{
  PetscFunctionBeginUser;
  *out = fopen(file, "w");
  PetscCheck(*out, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN, "%s cannot be written", file);
  fputs("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n", *out);
  PetscFunctionReturn(0);
}

static PetscErrorCode Close(FILE *out)
{
  PetscFunctionBeginUser;
  fputs("$EndElements\n", out);
  const PetscBool bad = ferror(out) != 0;
  PetscCheck(!fclose(out) && !bad, PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "a mesh cannot be written");
  PetscFunctionReturn(0);
}

PetscErrorCode KratosWriteGrid(const KratosProject *p, const char *file)
{
  PetscInt n = 1;
  FILE *out;

  PetscFunctionBeginUser;
  PetscCall(Open(file, &out));
  for (PetscInt a = 0; a < p->n_actions; ++a) n += first_of_part(p, a) ? 2 : 0;
  fprintf(out, "%" PetscInt_FMT "\n%" PetscInt_FMT " 1 \"grid\"\n", n, p->dim);
  for (PetscInt a = 0; a < p->n_actions; ++a)
    if (first_of_part(p, a))
      fprintf(out, "0 %" PetscInt_FMT " \"%s\"\n%" PetscInt_FMT " %" PetscInt_FMT " \"%s\"\n", a + 2,
              p->actions[a].name, p->dim - 1, a + 2, p->actions[a].name);
  fputs("$EndPhysicalNames\n", out);
  write_nodes(out, p->grid);
  fprintf(out, "$Elements\n%" PetscInt_FMT "\n", write_grid_elements(NULL, p));
  (void)write_grid_elements(out, p);
  PetscCall(Close(out));
  PetscFunctionReturn(0);
}

static PetscInt write_body_elements(FILE *out, const KratosProject *p)
{
  PetscInt number = 0;
  for (PetscInt b = 0; b < p->n_bodies; ++b)
    number = write_cells(out, p->body, &mdpa_part(p->body, p->bodies[b].part)->elements, b + 1, p->dim, number);
  return number;
}

PetscErrorCode KratosWriteBody(const KratosProject *p, const char *file)
{
  FILE *out;

  PetscFunctionBeginUser;
  PetscCall(Open(file, &out));
  fprintf(out, "%" PetscInt_FMT "\n", p->n_bodies);
  for (PetscInt b = 0; b < p->n_bodies; ++b)
    fprintf(out, "%" PetscInt_FMT " %" PetscInt_FMT " \"%s\"\n", p->dim, b + 1, p->bodies[b].name);
  fputs("$EndPhysicalNames\n", out);
  write_nodes(out, p->body);
  fprintf(out, "$Elements\n%" PetscInt_FMT "\n", write_body_elements(NULL, p));
  (void)write_body_elements(out, p);
  PetscCall(Close(out));
  PetscFunctionReturn(0);
}
