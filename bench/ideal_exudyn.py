#!/usr/bin/env python3
"""The launch of bench/ideal.yaml in Exudyn (1.11), in a plane and in space: error and CPU time of its solver, least of
some, for the meshes and steps of docs/performance.md. All errors are against a fine run in a plane.

    python3 bench/ideal_exudyn.py
"""
import os
import sys
import time

import numpy as np

sys.exudynFast = True  # without range checks
import exudyn as exu  # noqa: E402
import exudyn.itemInterface as item  # noqa: E402

LENGTH, AREA = 3.0, np.pi * (0.085**2 - 0.0825**2)  # [m], [m2]
BENDING, AXIAL, LINE = 210e9 * np.pi / 4 * (0.085**4 - 0.0825**4), 210e9 * AREA, 7850 * AREA  # [N.m2], [N], [kg/m]
WEIGHT = -9.81 * np.array([np.sin(np.radians(20)), np.cos(np.radians(20)), 0])  # along and across the tube [m/s2]
END, FREED = 0.153, 0.09  # [s] the front point is freed where it passes the tip
PEAK = 4.781e-4  # of the tip's deflection [m]
FINE = (2, 4, 14, 12, 200, True)
CASES = (  # dimensions; elements to the first support, the second, the tip; steps a millisecond; sparse; runs
    (2, 1, 2, 2, 3, False, 7), (2, 1, 4, 3, 9, False, 5), (2, 1, 4, 4, 16, False, 5), (2, 2, 7, 6, 60, True, 3),
    (3, 1, 2, 2, 5, True, 5), (3, 1, 4, 3, 34, True, 4), (3, 2, 5, 4, 60, True, 1), (3, 2, 7, 6, 100, True, 1))


def add_tube(mbs, dimensions, stations, supported):
    """Cables with tail and supports: the tube's nodes and cables."""
    plane, cables = dimensions == 2, []
    make = item.NodePoint2DSlope1 if plane else item.NodePointSlope1
    cable = item.ObjectANCFCable2D if plane else item.ObjectANCFCable
    rest = [0] * (dimensions - 1)
    nodes = [mbs.AddNode(make(referenceCoordinates=[x, *rest, 1, *rest])) for x in stations]
    for i in range(len(stations) - 1):
        cables.append(mbs.AddObject(cable(
            physicsLength=stations[i + 1] - stations[i], physicsMassPerLength=LINE, physicsBendingStiffness=BENDING,
            physicsAxialStiffness=AXIAL, nodeNumbers=[nodes[i], nodes[i + 1]])))
        add_weight(mbs, cables[-1])
    # 8 kg 0.1 m behind the first node, 0.06 kg m2, in the node's small displacements and slopes
    one = np.eye(dimensions)
    turning = 0.08 * one + np.diag([0] + [0.06] * (dimensions - 1))
    force = 8 * WEIGHT[:dimensions]
    mbs.AddObject(item.ObjectGenericODE2(
        nodeNumbers=[nodes[0]], massMatrix=np.block([[8 * one, -0.8 * one], [-0.8 * one, turning]]),
        forceVector=np.concatenate([force, -0.1 * force])))
    ground = mbs.AddNode(item.NodePointGround())
    fixed = mbs.AddMarker(item.MarkerNodeCoordinate(nodeNumber=ground, coordinate=0))
    for node in supported:
        for k in range(2 * dimensions):
            if k == dimensions:
                continue  # the slope along the tube
            stiffness = 2e7 if k < dimensions else 2e5
            moving = mbs.AddMarker(item.MarkerNodeCoordinate(nodeNumber=nodes[node], coordinate=k))
            mbs.AddObject(item.ObjectConnectorCoordinateSpringDamper(
                markerNumbers=[fixed, moving], stiffness=stiffness, damping=1e-3 * stiffness))
    return nodes, cables


def add_weight(mbs, body):
    marker = mbs.AddMarker(item.MarkerBodyMass(bodyNumber=body))
    mbs.AddLoad(item.LoadMassProportional(markerNumber=marker, loadVector=WEIGHT))


def add_rocket(mbs, dimensions, stations, cables):
    """The rocket, its mass centre at 1.3 m, on two joints that slide: the front one."""
    plane = dimensions == 2
    if plane:
        node = mbs.AddNode(item.NodeRigidBody2D(referenceCoordinates=[1.3, 0, 0]))
        rocket = mbs.AddObject(item.ObjectRigidBody2D(physicsMass=60, physicsInertia=30, nodeNumber=node))
    else:
        node = mbs.AddNode(item.NodeRigidBodyRotVecLG(referenceCoordinates=[1.3, 0, 0, 0, 0, 0]))
        rocket = mbs.AddObject(item.ObjectRigidBody(physicsMass=60, physicsInertia=[0.25, 30, 30, 0, 0, 0],
                                                    nodeNumber=node))
    add_weight(mbs, rocket)
    center = mbs.AddMarker(item.MarkerBodyRigid(bodyNumber=rocket))
    mbs.AddLoad(item.LoadForceVector(markerNumber=center, loadVector=[15e3, 0, 0], bodyFixed=True))
    shape = item.MarkerBodyCable2DCoordinates if plane else item.MarkerBodyBeamShape
    along = [mbs.AddMarker(shape(bodyNumber=cable)) for cable in cables]
    joint, options = item.ObjectJointSliding2D, {"classicalFormulation": False}
    if not plane:
        joint, options = item.ObjectJointSliding, {"constrainRotations": [0, 0, 0]}
    for at in (0.1, 2.0):
        point = mbs.AddMarker(item.MarkerBodyRigid(bodyNumber=rocket, localPosition=[at - 1.3, 0, 0]))
        cable = int(np.searchsorted(stations, at, side="right")) - 1
        data = mbs.AddNode(item.NodeGenericData(initialCoordinates=[cable, at], numberOfDataCoordinates=2))
        front = mbs.AddObject(joint(
            markerNumbers=[point, along[cable]], slidingMarkerNumbers=along, slidingMarkerOffsets=list(stations[:-1]),
            nodeNumber=data, **options))
    return front


def settings_of(start, end, steps, sparse):
    settings = exu.SimulationSettings()
    settings.solutionSettings.writeSolutionToFile = False
    settings.solutionSettings.sensorsWritePeriod = 1e-3
    settings.linearSolverType = exu.LinearSolverType.EigenSparse if sparse else exu.LinearSolverType.EXUdense
    integration = settings.timeIntegration
    integration.verboseMode = 0
    integration.startTime, integration.endTime = start, end
    integration.numberOfSteps = round(1e3 * (end - start)) * steps
    integration.newton.useModifiedNewton = True
    integration.generalizedAlpha.spectralRadius = 0.9
    return settings


def launch(dimensions, to_first, to_second, to_tip, steps, sparse):
    """The tip's deflection at every millisecond [m], CPU time of the solver [s]."""
    stations = np.concatenate([np.linspace(0, 0.4, to_first + 1), np.linspace(0.4, 1.8, to_second + 1)[1:],
                               np.linspace(1.8, LENGTH, to_tip + 1)[1:]])
    mbs = exu.SystemContainer().AddSystem()
    nodes, cables = add_tube(mbs, dimensions, stations, (to_first, to_first + to_second))
    front = add_rocket(mbs, dimensions, stations, cables)
    tip = mbs.AddSensor(item.SensorNode(
        nodeNumber=nodes[-1], outputVariableType=exu.OutputVariableType.Displacement, storeInternal=True,
        writeToFile=False))
    mbs.Assemble()
    cpu, deflection = 0, np.zeros(round(1e3 * END) + 1)
    for start, end in ((0, FREED), (FREED, END)):
        settings = settings_of(start, end, steps, sparse)
        if start:
            state, rates = mbs.systemData.GetSystemState(), mbs.systemData.GetODE2Coordinates_tt()
            mbs.SetObjectParameter(front, "activeConnector", False)
            mbs.systemData.SetSystemState(state, configuration=exu.ConfigurationType.Initial)
            mbs.systemData.SetODE2Coordinates_tt(rates, configuration=exu.ConfigurationType.Initial)
        solver = exu.MainSolverImplicitSecondOrder()
        before = time.process_time()
        if not solver.SolveSystem(mbs, settings):
            sys.exit("the solver failed")
        cpu += time.process_time() - before
        for row in mbs.GetSensorStoredData(tip):
            deflection[round(1e3 * row[0])] = row[2]
    return deflection, cpu


def main():
    print("load of the machine at the start: %.1f" % os.getloadavg()[0])
    truth, _ = launch(*FINE)
    for *case, runs in CASES:
        tries = [launch(*case) for _ in range(runs)]
        error = np.max(np.abs(tries[0][0] - truth)) / PEAK
        print("%d dimensions, %2d elements, %3d steps/ms: error %.3f %%, least of %d %6.1f ms" % (
            case[0], sum(case[1:4]), case[4], 100 * error, runs, 1e3 * min(cpu for _, cpu in tries)), flush=True)


if __name__ == "__main__":
    main()
