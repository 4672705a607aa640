/* Counts what a rank says to others: MPI's profiling interface (MPI_ stands here, PMPI_ in the
 * library) sees the calls of this program and of PETSc.
 *
 * Included by one program, before PETSc's headers, which hide MPI behind macros. A call is charged
 * to the phase of the step in which it happens. No phase says when it begins; but all read MPI's
 * clock at their ends, and then add to their seconds: calls between two readings form a span, and
 * the span belongs to the phase whose seconds have grown when the next call comes. */
#pragma once
#include <mpi.h>
#include <string.h>

#define MESSAGE_PHASES 16
#define MESSAGE_SPANS 64
#define MESSAGE_REQUESTS 1024
#define MESSAGE_RANKS 4096

typedef struct {
  double messages, bytes;           /* sent to one other rank */
  double collectives, shared_bytes; /* calls, and what this rank hands in */
} MessageCount;

static struct {
  int on;
  void (*clock)(double seconds[MESSAGE_PHASES]);
  int (*takes_all)(int phase); /* are all open spans the phase's? else the last alone */
  int n_phases;
  double seconds[MESSAGE_PHASES];
  MessageCount phase[MESSAGE_PHASES + 1], span[MESSAGE_SPANS]; /* the last phase: none */
  /* closed ones; span[n_spans] is open */
  int n_spans;
  struct {
    MPI_Request request;
    double bytes;
    int to;
  } persistent[MESSAGE_REQUESTS];
  int n_persistent;
  unsigned char partner[MESSAGE_RANKS];
} messages;

static void message_add(MessageCount *to, const MessageCount *from)
{
  to->messages += from->messages;
  to->bytes += from->bytes;
  to->collectives += from->collectives;
  to->shared_bytes += from->shared_bytes;
}

/* Closed spans from `first` on belong to a phase. */
static void message_charge(int phase, int first)
{
  for (int k = first; k < messages.n_spans; ++k) message_add(&messages.phase[phase], &messages.span[k]);
  messages.span[first] = messages.span[messages.n_spans];
  messages.n_spans = first;
}

/* Whose seconds have grown? */
static void message_settle(void)
{
  double now[MESSAGE_PHASES];
  if (!messages.on) return;
  messages.on = 0;
  messages.clock(now);
  messages.on = 1;
  for (int k = 0; k < messages.n_phases; ++k) {
    if (now[k] == messages.seconds[k]) continue;
    messages.seconds[k] = now[k];
    if (messages.n_spans) message_charge(k, messages.takes_all(k) ? 0 : messages.n_spans - 1);
  }
}

static void message_begin(int n_phases, void (*clock)(double *), int (*takes_all)(int))
{
  memset(messages.phase, 0, sizeof messages.phase);
  memset(messages.partner, 0, sizeof messages.partner);
  messages.n_phases = n_phases;
  messages.clock = clock;
  messages.takes_all = takes_all;
  messages.n_spans = 0;
  messages.span[0] = (MessageCount){0};
  clock(messages.seconds);
  messages.on = 1;
}

/* What no phase has taken goes to the last. */
static void message_end(void)
{
  message_settle();
  messages.on = 0;
  ++messages.n_spans;
  message_charge(messages.n_phases, 0);
}

double MPI_Wtime(void)
{
  message_settle();
  if (messages.on) {
    if (messages.n_spans == MESSAGE_SPANS - 1) { /* too many: the oldest two are one */
      message_add(&messages.span[1], &messages.span[0]);
      memmove(messages.span, messages.span + 1, sizeof messages.span - sizeof *messages.span);
      --messages.n_spans;
    }
    messages.span[++messages.n_spans] = (MessageCount){0};
  }
  return PMPI_Wtime();
}

static double message_bytes(int count, MPI_Datatype type)
{
  int size;
  PMPI_Type_size(type, &size);
  return (double)count * size;
}

static void message_sent(double bytes, int to)
{
  if (!messages.on || to < 0) return;
  message_settle();
  ++messages.span[messages.n_spans].messages;
  messages.span[messages.n_spans].bytes += bytes;
  if (to < MESSAGE_RANKS) messages.partner[to] = 1;
}

static void message_shared(double bytes)
{
  if (!messages.on) return;
  message_settle();
  ++messages.span[messages.n_spans].collectives;
  messages.span[messages.n_spans].shared_bytes += bytes;
}

int MPI_Send(const void *data, int n, MPI_Datatype type, int to, int tag, MPI_Comm comm)
{
  message_sent(message_bytes(n, type), to);
  return PMPI_Send(data, n, type, to, tag, comm);
}

int MPI_Isend(const void *data, int n, MPI_Datatype type, int to, int tag, MPI_Comm comm, MPI_Request *request)
{
  message_sent(message_bytes(n, type), to);
  return PMPI_Isend(data, n, type, to, tag, comm, request);
}

int MPI_Issend(const void *data, int n, MPI_Datatype type, int to, int tag, MPI_Comm comm, MPI_Request *request)
{
  message_sent(message_bytes(n, type), to);
  return PMPI_Issend(data, n, type, to, tag, comm, request);
}

int MPI_Send_init(const void *data, int n, MPI_Datatype type, int to, int tag, MPI_Comm comm, MPI_Request *request)
{
  const int result = PMPI_Send_init(data, n, type, to, tag, comm, request);
  if (messages.n_persistent < MESSAGE_REQUESTS) {
    messages.persistent[messages.n_persistent].request = *request;
    messages.persistent[messages.n_persistent].bytes = message_bytes(n, type);
    messages.persistent[messages.n_persistent++].to = to;
  }
  return result;
}

static void message_started(MPI_Request request)
{
  for (int k = 0; k < messages.n_persistent; ++k)
    if (messages.persistent[k].request == request)
      message_sent(messages.persistent[k].bytes, messages.persistent[k].to);
}

int MPI_Start(MPI_Request *request)
{
  message_started(*request);
  return PMPI_Start(request);
}

int MPI_Startall(int n, MPI_Request request[])
{
  for (int k = 0; k < n; ++k) message_started(request[k]);
  return PMPI_Startall(n, request);
}

int MPI_Request_free(MPI_Request *request)
{
  for (int k = 0; k < messages.n_persistent; ++k)
    if (messages.persistent[k].request == *request)
      messages.persistent[k--] = messages.persistent[--messages.n_persistent];
  return PMPI_Request_free(request);
}

int MPI_Allreduce(const void *in, void *out, int n, MPI_Datatype type, MPI_Op op, MPI_Comm comm)
{
  message_shared(message_bytes(n, type));
  return PMPI_Allreduce(in, out, n, type, op, comm);
}

int MPI_Iallreduce(const void *in, void *out, int n, MPI_Datatype type, MPI_Op op, MPI_Comm comm, MPI_Request *request)
{
  message_shared(message_bytes(n, type));
  return PMPI_Iallreduce(in, out, n, type, op, comm, request);
}

int MPI_Reduce(const void *in, void *out, int n, MPI_Datatype type, MPI_Op op, int root, MPI_Comm comm)
{
  message_shared(message_bytes(n, type));
  return PMPI_Reduce(in, out, n, type, op, root, comm);
}

int MPI_Exscan(const void *in, void *out, int n, MPI_Datatype type, MPI_Op op, MPI_Comm comm)
{
  message_shared(message_bytes(n, type));
  return PMPI_Exscan(in, out, n, type, op, comm);
}

int MPI_Scan(const void *in, void *out, int n, MPI_Datatype type, MPI_Op op, MPI_Comm comm)
{
  message_shared(message_bytes(n, type));
  return PMPI_Scan(in, out, n, type, op, comm);
}

int MPI_Bcast(void *data, int n, MPI_Datatype type, int root, MPI_Comm comm)
{
  message_shared(message_bytes(n, type));
  return PMPI_Bcast(data, n, type, root, comm);
}

int MPI_Allgather(const void *in, int n, MPI_Datatype type, void *out, int m, MPI_Datatype type_out, MPI_Comm comm)
{
  message_shared(message_bytes(n, type));
  return PMPI_Allgather(in, n, type, out, m, type_out, comm);
}

int MPI_Allgatherv(const void *in, int n, MPI_Datatype type, void *out, const int *m, const int *start,
                   MPI_Datatype type_out, MPI_Comm comm)
{
  message_shared(message_bytes(n, type));
  return PMPI_Allgatherv(in, n, type, out, m, start, type_out, comm);
}

int MPI_Alltoall(const void *in, int n, MPI_Datatype type, void *out, int m, MPI_Datatype type_out, MPI_Comm comm)
{
  message_shared(message_bytes(n, type));
  return PMPI_Alltoall(in, n, type, out, m, type_out, comm);
}

int MPI_Reduce_scatter_block(const void *in, void *out, int n, MPI_Datatype type, MPI_Op op, MPI_Comm comm)
{
  message_shared(message_bytes(n, type));
  return PMPI_Reduce_scatter_block(in, out, n, type, op, comm);
}

int MPI_Barrier(MPI_Comm comm)
{
  message_shared(0);
  return PMPI_Barrier(comm);
}

int MPI_Ibarrier(MPI_Comm comm, MPI_Request *request)
{
  message_shared(0);
  return PMPI_Ibarrier(comm, request);
}
