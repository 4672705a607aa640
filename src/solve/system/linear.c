#include "solve/system/linear.h"
#include "solve/blocks/blocks.h"

/* cells that a wave crosses in a step up to which a dynamic problem is solved by iteration first: in
 * space, in the plane, there with an unsymmetric tangent */
#define ITERATE_BELOW_3D 1000
#define ITERATE_BELOW_2D 300
#define ITERATE_BELOW_SOIL 100
/* cells that a wave crosses in a step up to which unsymmetric systems with multipliers take
 * projections */
#define PROJECT_BELOW 3
/* cells that a wave crosses in a step from which on ILU of unsymmetric systems has a first
 * level */
#define REFINE_ABOVE 3

static PetscErrorCode UseDirect(KSP ksp, PetscBool symmetric, const char **what)
{
  PC pc;
  PetscFunctionBeginUser;
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(KSPSetType(ksp, KSPPREONLY));
  PetscCall(PCSetType(pc, symmetric ? PCCHOLESKY : PCLU));
  PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
  *what = symmetric ? "direct (MUMPS, symmetric)" : "direct (MUMPS)";
  PetscFunctionReturn(0);
}

/* Rows of multipliers have no diagonal, so their pivots come late, and the factor outgrows the
 * estimate of the analysis. */
#define ROOM_FOR_PIVOTS 300 /* percent */

static PetscErrorCode LeaveRoom(KSP ksp, PetscInt percent)
{
  PC pc;
  Mat factor;
  PetscFunctionBeginUser;
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCFactorSetUpMatSolverType(pc));
  PetscCall(PCFactorGetMatrix(pc, &factor));
  PetscCall(MatMumpsSetIcntl(factor, 14, percent));
  PetscFunctionReturn(0);
}

/* The mass dominates: a cheap preconditioner on each rank's part, and as few bytes as possible.
 * Symmetric Gauss-Seidel by Eisenstat's trick costs no more than the product with the matrix, needs
 * no set-up and cannot be indefinite, as incomplete factorisations can. */
static PetscErrorCode UseBlocks(KSP ksp, const LinearProblem *p, const char **what)
{
  PC pc;
  PetscFunctionBeginUser;
  PetscCall(BlocksRegister());
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, PCNONE)); /* it is in the method */
  PetscCall(KSPSetType(ksp, KSPBLOCKS));
  PetscCall(BlocksMayFactor(ksp, linear_factor_fits(p)));
  PetscCall(KSPSetTolerances(ksp, 1e-4, PETSC_DEFAULT, PETSC_DEFAULT, 500));
  *what = p->symmetric ? "conjugate gradients, symmetric Gauss-Seidel" : "BiCGStab, symmetric Gauss-Seidel";
  PetscFunctionReturn(0);
}

/* The same with PETSc's matrix and methods, where options ask for one. */
static PetscErrorCode UseKrylov(KSP ksp, const LinearProblem *p, const char **what)
{
  PC pc;
  PetscFunctionBeginUser;
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(KSPSetType(ksp, p->symmetric ? KSPCG : KSPBCGS));
  if (!p->symmetric) PetscCall(PCSetType(pc, PCBJACOBI));
  else
    PetscCall(
      /* PETSc 3.18's trick fails where a rank has no rows */
      PCSetType(pc, p->idle_ranks ? PCSOR : PCEISENSTAT));
  *what = p->symmetric ? "conjugate gradients, symmetric Gauss-Seidel" : "BiCGStab, block Jacobi with ILU";
  PetscCall(KSPSetTolerances(ksp, 1e-4, PETSC_DEFAULT, PETSC_DEFAULT, 500));
  PetscFunctionReturn(0);
}

/* A step in which waves cross several cells couples neighbours so strongly that fill of the first
 * level pays. The blocks exist only once the preconditioner is set up; what the user asked for
 * stays. */
PetscErrorCode LinearRefine(KSP ksp, Mat matrix, const LinearProblem *p)
{
  PC pc, block;
  KSP *blocks;
  PetscInt n;
  PetscBool is_blocks, asked;

  PetscFunctionBeginUser;
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PetscObjectTypeCompare((PetscObject)pc, PCBJACOBI, &is_blocks));
  PetscCall(PetscOptionsHasName(NULL, NULL, "-sub_pc_factor_levels", &asked));
  if (!is_blocks || asked || p->symmetric || p->courant < REFINE_ABOVE) PetscFunctionReturn(0);
  PetscCall(KSPSetOperators(ksp, matrix, matrix));
  PetscCall(PCSetUp(pc));
  PetscCall(PCBJacobiGetSubKSP(pc, &n, NULL, &blocks));
  for (PetscInt k = 0; k < n; ++k) {
    PetscCall(KSPGetPC(blocks[k], &block));
    PetscCall(PCFactorSetLevels(block, 1));
  }
  PetscFunctionReturn(0);
}

/* The last front of a saddle point may hold pressures that nothing but each other fixes. Spread
 * over the ranks by ScaLAPACK it is factorised without pivots of two rows, and fails there; on one
 * rank it is not. Without stabilisation the matrix may be singular for pressures that no point
 * feels (docs/theory.md, "Mixed formulation"): these are set to 0. */
static PetscErrorCode PrepareSaddlePoint(KSP ksp, PetscBool undetermined)
{
  PC pc;
  Mat factor;
  PetscFunctionBeginUser;
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCFactorSetUpMatSolverType(pc));
  PetscCall(PCFactorGetMatrix(pc, &factor));
  PetscCall(MatMumpsSetIcntl(factor, 13, 1));
  PetscCall(MatMumpsSetIcntl(factor, 24, undetermined));
  PetscFunctionReturn(0);
}

/* Couplings below this share of what holds their nodes do not count in coarsening, and above all not
 * the zeros of cells that the pattern keeps for points to come (docs/experiments/linear-solvers.md). */
#define WEAKEST_LINK 0.02
/* what takes more has failed, and a factorisation is tried: 15 to 30 are usual */
#define MOST_CYCLES 300

PetscErrorCode LinearMultigrid(PC pc)
{
  PetscReal weakest[] = {WEAKEST_LINK};
  PetscFunctionBeginUser;
  PetscCall(PCSetType(pc, PCGAMG));
  PetscCall(PCGAMGSetThreshold(pc, weakest, 1));
  PetscFunctionReturn(0);
}

static PetscErrorCode UseMultigrid(KSP ksp, const LinearProblem *p, const char **what)
{
  PC pc;
  PetscFunctionBeginUser;
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(KSPSetType(ksp, p->symmetric ? KSPCG : KSPGMRES));
  PetscCall(LinearMultigrid(pc));
  if (!p->symmetric) PetscCall(KSPSetPCSide(ksp, PC_RIGHT)); /* what falls is the residual itself */
  PetscCall(KSPGMRESSetRestart(ksp, 100));
  PetscCall(KSPSetTolerances(ksp, 1e-8, PETSC_DEFAULT, PETSC_DEFAULT, MOST_CYCLES));
  *what = p->symmetric ? "conjugate gradients, algebraic multigrid" : "GMRES, algebraic multigrid";
  PetscFunctionReturn(0);
}

static PetscReal iterate_below(const LinearProblem *p)
{
  if (p->dim == 3) return ITERATE_BELOW_3D;
  return p->symmetric ? ITERATE_BELOW_2D : ITERATE_BELOW_SOIL;
}

/* Unknowns below which a factorisation is cheaper than multigrid, in statics, and below which it is cheaper than two
 * levels of a box. Fill-in makes it costly much earlier in space than in the plane, where the tangents of soil are left
 * to it: near failure multigrid may not find their solution (docs/experiments/linear-solvers.md). */
#define FACTORISE_BELOW_3D 5000
#define FACTORISE_BELOW_3D_SOIL 10000
#define FACTORISE_BELOW_3D_LEVELS 1000
#define FACTORISE_BELOW_2D_LEVELS 5000
/* near failure tangents have modes that hardly anything resists, and iterations become many */
#define FACTORISE_BELOW_3D_FAILING 25000
#define FACTORISE_BELOW_2D 150000
#define FACTORISE_BELOW_2D_SOIL 1000000
#define FACTORISE_BELOW_3D_MIXED 20000
#define FACTORISE_BELOW_2D_MIXED 500000

static PetscInt factorise_below(const LinearProblem *p)
{
  if (p->mixed) return p->dim == 2 ? FACTORISE_BELOW_2D_MIXED : FACTORISE_BELOW_3D_MIXED;
  if (p->dim == 2 && (p->failing || !p->symmetric)) return FACTORISE_BELOW_2D_SOIL;
  if (p->dim == 2) return p->levels ? FACTORISE_BELOW_2D_LEVELS : FACTORISE_BELOW_2D;
  if (p->failing) return FACTORISE_BELOW_3D_FAILING;
  if (p->levels) return FACTORISE_BELOW_3D_LEVELS;
  return p->symmetric ? FACTORISE_BELOW_3D : FACTORISE_BELOW_3D_SOIL;
}

/* Fill-in of nested dissection grows as n log n in the plane and as n^(4/3) in space. Numbers of MUMPS and PETSc's
 * copies together, of nodes that see those of the cells around them; pressures, and both triangles of unsymmetric
 * tangents, take more. */
static PetscReal factor_bytes_of_cells(const LinearProblem *p, PetscReal n)
{
  if (p->dim == 3) return (p->mixed || !p->symmetric ? 530 : 280) * PetscPowReal(n, 4.0 / 3.0);
  return (p->mixed ? 175 : p->symmetric ? 90 : 132) * n * PetscLog2Real(n);
}

/* Nodes that see farther are parted by separators as wide as they see, r cells: there are (2 r + 1)^dim nodes in a row,
 * and numbers between separators grow as r^2. The copy for MUMPS, values with rows and columns, is large then. */
PetscReal linear_factor_bytes(const LinearProblem *p)
{
  const PetscReal n = (PetscReal)PetscMax(p->unknowns, 2), block = (PetscReal)PetscMax(p->block, 1),
                  of_cells = (p->dim == 3 ? 27 : 9) * n / block, wider = PetscMax(p->pairs / of_cells, 1),
                  copied = (wider - 1) * of_cells * block * block * (p->symmetric ? 8 : 16);
  return PetscPowReal(wider, 2.0 / (PetscReal)p->dim) * factor_bytes_of_cells(p, n) + copied;
}

PetscBool linear_factor_fits(const LinearProblem *p)
{
  return (PetscBool)(p->memory <= 0 || linear_factor_bytes(p) < p->memory);
}

static PetscBool direct_pays(const LinearProblem *p)
{
  if (p->dynamic && !p->mixed && p->courant < iterate_below(p)) return PETSC_FALSE;
  return (PetscBool)(p->unknowns < factorise_below(p) && linear_factor_fits(p));
}

PetscBool linear_factorises(const LinearProblem *p)
{
  return p->choice == LINEAR_DIRECT || (p->choice == LINEAR_AUTO && direct_pays(p));
}

PetscErrorCode LinearForm(const LinearProblem *p, SystemForm *form)
{
  PetscBool method, preconditioner;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsHasName(NULL, NULL, "-ksp_type", &method));
  PetscCall(PetscOptionsHasName(NULL, NULL, "-pc_type", &preconditioner));
  const PetscBool usable = !p->multipliers || p->symmetric || p->courant < PROJECT_BELOW;
  *form = SYSTEM_ASSEMBLED;
  if (p->mixed || preconditioner || linear_factorises(p)) PetscFunctionReturn(0);
  if (p->dynamic && usable && !method) *form = SYSTEM_BLOCKS;
  if (!p->dynamic && p->levels && !p->multipliers) *form = SYSTEM_GATHERED;
  PetscFunctionReturn(0);
}

PetscErrorCode LinearConfigure(KSP ksp, const LinearProblem *p, PetscBool *direct, const char **what)
{
  SystemForm form;

  PetscFunctionBeginUser;
  PetscCall(LinearForm(p, &form));
  /* multipliers in a matrix make it indefinite */
  *direct = linear_factorises(p) || (p->multipliers && form != SYSTEM_BLOCKS);
  if (*direct) PetscCall(UseDirect(ksp, p->symmetric, what));
  if (*direct && p->mixed) PetscCall(PrepareSaddlePoint(ksp, p->undetermined));
  const PetscInt room = PetscMax(p->room, p->multipliers ? ROOM_FOR_PIVOTS : 0);
  if (*direct && room) PetscCall(LeaveRoom(ksp, room));
  if (*direct) PetscFunctionReturn(0);
  if (p->mixed) { /* saddle.c does the rest */
    *what = "GMRES, Schur complement, algebraic multigrid";
    PetscFunctionReturn(0);
  }
  if (form == SYSTEM_BLOCKS) PetscCall(UseBlocks(ksp, p, what));
  else if (p->dynamic) PetscCall(UseKrylov(ksp, p, what));
  else PetscCall(UseMultigrid(ksp, p, what));
  PetscFunctionReturn(0);
}
