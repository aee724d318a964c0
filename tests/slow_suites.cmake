# Suites that are left out of `ctest -L quick`: each takes more than two seconds alone.
set(ayumi_slow_suites
  check.Consequence check.Consistency check.FaultsOnPatterns check.PlantedFault check.PlantedMistakes check.SecondRoute
  check.SecondRouteOfClearance cli.AuthorServer cli.BrokenInput cli.CertifyCommand cli.CheckRepair cli.CompareCommand cli.Edit cli.ExplainCommand
  cli.Export cli.GainsCommand cli.Infeasible cli.NewJump cli.NewViip cli.NewWalk cli.OneSet cli.PushCommand
  cli.Repeat cli.RobotPath cli.Run cli.Selftest cli.SweepCommand cli.SweepOnSlurm cli.TuneCommand control.FootholdShift docs.CommandsOfPage
  identify.Compare identify.ExciteBacklash identify.ExciteRoundTrip identify.Identify identify.IdentifyHoap3 identify.IdentifyIntervals model.Diagnose plan.Sample plant_mujoco.MujocoDisturbance plant_mujoco.MujocoJump
  plant_mujoco.MujocoPlant plant_mujoco.MujocoWalk plant_mujoco.PushAgreement
  plant_mujoco.RepairedWalk render.Batch render.Clip render.Commands render.Renderer
  repair.ConstraintRows repair.CorrectionProblem repair.Faults repair.JumpRepair repair.Landing
  repair.LeastChange repair.Repair repair.ThrownKnee report.AuthorPage report.Report scenarios.Baselines scenarios.Hoap1Walk
  scenarios.SensorLatency scenarios.ViipHoap1 sim.Walking study.Certify study.Push study.Retime study.SequentialTest)
