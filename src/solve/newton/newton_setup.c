/* SNES, its line search and the linear solver below it, made for one pattern of the system. */
#include "solve/newton/newton_private.h"
#include "solve/levels/two_levels.h"
#include "solve/system/rigid_motions.h"
#include <petsctime.h>

PetscErrorCode NewtonReset(Newton *n)
{
  PetscFunctionBeginUser;
  PetscCall(SNESDestroy(&n->snes));
  PetscCall(SaddleClear(&n->saddle));
  PetscCall(ProjectionDestroy(&n->projection));
  PetscCall(VecDestroy(&n->x));
  PetscCall(VecDestroy(&n->f));
  PetscCall(EliminationReset(&n->elimination));
  PetscFunctionReturn(0);
}

/* Of displacements alone, which nothing meets: pressures and multipliers make pivots negative that mean nothing, and
 * what slides between walls has some that are round-off. */
static PetscErrorCode CountNegative(Newton *n, KSP ksp)
{
  PetscBool symmetric;
  Mat factor;
  PC pc;

  PetscFunctionBeginUser;
  n->negative = -1;
  if (!n->direct || n->problem->pressure || n->problem->scene.contact) PetscFunctionReturn(0);
  if (nodal_forces_constraints(n->problem->forces)) PetscFunctionReturn(0);
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PetscObjectTypeCompare((PetscObject)pc, PCCHOLESKY, &symmetric));
  if (!symmetric) PetscFunctionReturn(0);
  PetscCall(PCFactorGetMatrix(pc, &factor));
  PetscCall(MatMumpsGetInfog(factor, 12, &n->negative));
  PetscFunctionReturn(0);
}

/* The preconditioner's set-up, factorisations too, belongs to the solve. */
static PetscErrorCode LinearSolved(KSP ksp, Vec b, Vec x, void *context)
{
  Newton *n = context;
  KSPConvergedReason reason;
  double end;

  (void)b, (void)x;
  PetscFunctionBeginUser;
  PetscCall(KSPGetConvergedReason(ksp, &reason));
  PetscCall(CountNegative(n, ksp));
  n->rescues += !n->direct && reason == KSP_CONVERGED_ITS; /* blocks_ksp.c */
  PetscCall(PetscTime(&end));
  n->t_linear += end - n->solving;
  PetscFunctionReturn(0);
}

/* Factorisations and point methods depend on their matrix alone. Algebraic multigrid builds its
 * interpolation once and keeps it as long as the pattern lives, so that a step would depend on all
 * steps before it, and a resumed run would be another one. */
static PetscErrorCode Learns(KSP ksp, PetscBool *learns)
{
  PC pc;

  PetscFunctionBeginUser;
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PetscObjectTypeCompareAny((PetscObject)pc, learns, PCNONE, PCJACOBI, PCPBJACOBI, PCVPBJACOBI, PCSOR,
                                      PCEISENSTAT, PCILU, PCICC, PCLU, PCCHOLESKY, PCBJACOBI, PCASM, ""));
  *learns = !*learns;
  PetscFunctionReturn(0);
}

static PetscErrorCode TellRigidMotions(const StepProblem *p)
{
  MatNullSpace rigid;

  PetscFunctionBeginUser;
  PetscCall(RigidMotions(p->system, p->grid, &rigid));
  PetscCall(MatSetNearNullSpace(p->system->matrix, rigid));
  PetscCall(MatNullSpaceDestroy(&rigid));
  PetscFunctionReturn(0);
}

/* Statics: two levels of the box where there is one, else algebraic multigrid. */
static PetscErrorCode UseLevels(StepProblem *p, const LinearProblem *linear, KSP ksp, const char **what)
{
  PC pc;

  PetscFunctionBeginUser;
  if (p->system->form != SYSTEM_GATHERED) {
    PetscCall(TellRigidMotions(p));
    PetscFunctionReturn(0);
  }
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(TwoLevelsConfigure(pc, p->system, p->grid, p->fixed, linear->symmetric));
  *what = linear->symmetric ? "conjugate gradients, two levels of the box" : "GMRES, two levels of the box";
  PetscFunctionReturn(0);
}

PetscErrorCode NewtonSetUp(Newton *n, StepProblem *p, const LinearProblem *linear)
{
  KSP ksp;
  SNESLineSearch search;
  SystemForm form;
  double start, end;

  PetscFunctionBeginUser;
  if (n->built == p->system->builds && !n->learns) PetscFunctionReturn(0);
  PetscCall(PetscTime(&start));
  PetscCall(NewtonReset(n));
  LinearProblem chosen = *linear;
  if (n->remembered == p->system->builds) chosen.courant = n->courant;
  n->courant = chosen.courant;
  n->remembered = -1;
  if ((n->retry && !n->anew) || newton_distrusts(n)) chosen.choice = LINEAR_DIRECT;
  chosen.room = n->room;
  PetscCall(LinearForm(&chosen, &form));
  n->projects = chosen.multipliers && form == SYSTEM_BLOCKS;
  PetscCall(SystemUse(p->system, form, linear->symmetric));
  /* projections take products with whole numbers */
  PetscCall(SystemGather(p->system, p->formulation->singles && !n->projects));
  const PetscBool eliminates = newton_eliminates(p, linear);
  if (eliminates) PetscCall(EliminationSetUp(&n->elimination, p));
  n->search.choose = eliminates ? NewtonChoose : NULL;
  n->search.settle = eliminates ? NewtonSettle : NULL;
  n->search.begin = NewtonBorderBegin;
  n->search.place = newton_border_place;
  n->search.end = newton_border_end;
  n->search.beside = newton_rigid_work;
  n->search.context = n;
  n->search.block = p->pressure ? p->system->block : 0;
  PetscCall(SystemCreateVec(p->system, &n->x));
  PetscCall(VecDuplicate(n->x, &n->f));
  PetscCall(SNESCreate(n->comm, &n->snes));
  PetscCall(SNESSetFunction(n->snes, n->f, NewtonFunction, n));
  PetscCall(SNESSetJacobian(n->snes, p->system->matrix, p->system->matrix, NewtonJacobian, n));
  PetscCall(SNESSetConvergenceTest(n->snes, NewtonConverged, n, NULL));
  PetscCall(SNESSetType(n->snes, SNESNEWTONLS));
  PetscCall(SNESGetLineSearch(n->snes, &search));
  PetscCall(SNESLineSearchSetType(search, SNESLINESEARCHSHELL));
  PetscCall(SNESLineSearchShellSetUserFunc(search, LineSearchDescend, &n->search));
  PetscCall(SNESGetKSP(n->snes, &ksp));
  /* some choices ask for the matrix at once */
  PetscCall(KSPSetOperators(ksp, p->system->matrix, p->system->matrix));
  PetscCall(KSPSetPostSolve(ksp, LinearSolved, n));
  PetscCall(LinearConfigure(ksp, &chosen, &n->direct, &n->linear));
  if (chosen.mixed && !n->direct) PetscCall(SaddleConfigure(&n->saddle, ksp, p->system, p->grid, chosen.dynamic));
  else if (!n->direct && !chosen.mixed && !chosen.dynamic) PetscCall(UseLevels(p, &chosen, ksp, &n->linear));
  PetscCall(SNESSetFromOptions(n->snes));
  PetscCall(LinearRefine(ksp, p->system->matrix, &chosen));
  PetscCall(Learns(ksp, &n->learns));
  PetscCall(NewtonForcingSetUp(n));
  n->built = p->system->builds;
  n->spoilt = PETSC_FALSE;
  PetscCall(PetscTime(&end));
  n->t_matrix += end - start;
  PetscFunctionReturn(0);
}
