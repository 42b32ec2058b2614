// The C interface of FMI 2.0.4, declared from the text of the standard (chapters 2.1, 3.2, 4.2), as
// far as an FMU gives it and an importer asks for it.
#ifndef LD_FMU_FMI2_INTERFACE_H
#define LD_FMU_FMI2_INTERFACE_H

#include <stddef.h>

typedef enum { fmi2OK, fmi2Warning, fmi2Discard, fmi2Error, fmi2Fatal, fmi2Pending } fmi2Status;
typedef enum { fmi2ModelExchange, fmi2CoSimulation } fmi2Type;
typedef enum {
    fmi2DoStepStatus,
    fmi2PendingStatus,
    fmi2LastSuccessfulTime,
    fmi2Terminated
} fmi2StatusKind;

typedef void (*fmi2Logger)(void *environment, const char *instance, fmi2Status status,
                           const char *category, const char *message, ...);

typedef struct {
    fmi2Logger logger;
    void *(*allocateMemory)(size_t count, size_t size);
    void (*freeMemory)(void *memory);
    void (*stepFinished)(void *environment, fmi2Status status);
    void *componentEnvironment;
} fmi2CallbackFunctions;

typedef struct {
    int newDiscreteStatesNeeded;
    int terminateSimulation;
    int nominalsOfContinuousStatesChanged;
    int valuesOfContinuousStatesChanged;
    int nextEventTimeDefined;
    double nextEventTime;
} fmi2EventInfo;

const char *fmi2GetTypesPlatform(void);
const char *fmi2GetVersion(void);
fmi2Status fmi2SetDebugLogging(void *c, int on, size_t count, const char *const *categories);
void *fmi2Instantiate(const char *name, fmi2Type type, const char *guid, const char *resources,
                      const fmi2CallbackFunctions *call, int visible, int logging);
void fmi2FreeInstance(void *c);
fmi2Status fmi2SetupExperiment(void *c, int tolerance_defined, double tolerance, double start,
                               int stop_defined, double stop);
fmi2Status fmi2EnterInitializationMode(void *c);
fmi2Status fmi2ExitInitializationMode(void *c);
fmi2Status fmi2Terminate(void *c);
fmi2Status fmi2Reset(void *c);
fmi2Status fmi2GetReal(void *c, const unsigned *reference, size_t count, double *value);
fmi2Status fmi2SetReal(void *c, const unsigned *reference, size_t count, const double *value);
fmi2Status fmi2GetBoolean(void *c, const unsigned *reference, size_t count, int *value);
fmi2Status fmi2SetBoolean(void *c, const unsigned *reference, size_t count, const int *value);
fmi2Status fmi2GetString(void *c, const unsigned *reference, size_t count, const char **value);
fmi2Status fmi2SetString(void *c, const unsigned *reference, size_t count,
                         const char *const *value);
fmi2Status fmi2GetInteger(void *c, const unsigned *reference, size_t count, int *value);
fmi2Status fmi2SetInteger(void *c, const unsigned *reference, size_t count, const int *value);
fmi2Status fmi2DoStep(void *c, double t, double size, int no_return);
fmi2Status fmi2CancelStep(void *c);
fmi2Status fmi2GetStatus(void *c, fmi2StatusKind kind, fmi2Status *value);
fmi2Status fmi2GetRealStatus(void *c, fmi2StatusKind kind, double *value);
fmi2Status fmi2GetIntegerStatus(void *c, fmi2StatusKind kind, int *value);
fmi2Status fmi2GetBooleanStatus(void *c, fmi2StatusKind kind, int *value);
fmi2Status fmi2GetStringStatus(void *c, fmi2StatusKind kind, const char **value);
fmi2Status fmi2SetRealInputDerivatives(void *c, const unsigned *reference, size_t count,
                                       const int *order, const double *value);
fmi2Status fmi2GetRealOutputDerivatives(void *c, const unsigned *reference, size_t count,
                                        const int *order, double *value);
fmi2Status fmi2GetDirectionalDerivative(void *c, const unsigned *unknown, size_t unknowns,
                                        const unsigned *known, size_t knowns, const double *seed,
                                        double *sensitivity);
fmi2Status fmi2FreeFMUstate(void *c, void **state);
fmi2Status fmi2GetFMUstate(void *c, void **state);
fmi2Status fmi2SetFMUstate(void *c, void *state);
fmi2Status fmi2SerializedFMUstateSize(void *c, void *state, size_t *size);
fmi2Status fmi2SerializeFMUstate(void *c, void *state, char *bytes, size_t size);
fmi2Status fmi2DeSerializeFMUstate(void *c, const char *bytes, size_t size, void **state);
fmi2Status fmi2EnterEventMode(void *c);
fmi2Status fmi2NewDiscreteStates(void *c, fmi2EventInfo *info);
fmi2Status fmi2EnterContinuousTimeMode(void *c);
fmi2Status fmi2CompletedIntegratorStep(void *c, int no_return, int *enter_event, int *terminate);
fmi2Status fmi2SetTime(void *c, double t);
fmi2Status fmi2SetContinuousStates(void *c, const double *x, size_t count);
fmi2Status fmi2GetDerivatives(void *c, double *rate, size_t count);
fmi2Status fmi2GetEventIndicators(void *c, double *indicator, size_t count);
fmi2Status fmi2GetContinuousStates(void *c, double *x, size_t count);
fmi2Status fmi2GetNominalsOfContinuousStates(void *c, double *nominal, size_t count);

#endif
