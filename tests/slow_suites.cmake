# Suites that are left out of `ctest -L quick`: each takes more than two seconds alone.
set(ayumi_slow_suites
  check.Consequence check.Consistency check.Contradictions check.FaultsOnPatterns
  check.FindingGroups check.PlantedFault check.PlantedMistakes check.SecondRoute
  check.SecondRouteOfClearance cli.AuthorServer cli.BrokenInput cli.CertifyCommand cli.CheckRepair
  cli.ChecksOn80Columns cli.CompareCommand cli.Edit cli.ExplainCommand cli.Export cli.GainsCommand
  cli.Gaits cli.IdentifyCommand cli.Infeasible cli.Init cli.LogExport cli.NewJump cli.NewKinds
  cli.NewViip cli.NewWalk cli.OneSet cli.PostureCommand cli.PushCommand cli.Repeat cli.Replay
  cli.RobotPath cli.Run cli.Selftest cli.Stopping cli.SweepCommand cli.SweepOnSlurm
  cli.TuneCommand control.FootholdShift docs.CommandsOfPage identify.Compare
  identify.ExciteBacklash identify.ExciteRoundTrip identify.Identify identify.IdentifyHoap3
  identify.IdentifyIntervals io.LogInBlocks io.LogWriter io.UnreadableMotions model.Diagnose
  plan.Sample plant_mujoco.MujocoDisturbance plant_mujoco.MujocoGround plant_mujoco.MujocoJump
  plant_mujoco.MujocoPlant plant_mujoco.MujocoWalk plant_mujoco.PushAgreement
  plant_mujoco.RepairedWalk plant_mujoco.ServoAgreement render.Batch render.Clip render.Commands
  render.Renderer repair.BadStarts repair.ConstraintRows repair.CorrectionProblem repair.Faults
  repair.FromScratch repair.InfeasibilityReport repair.JumpRepair repair.Landing
  repair.LeastChange repair.Repair repair.ThrownKnee report.AuthorPage report.Report
  scenarios.Baselines scenarios.DtadGaits scenarios.Hoap1Walk scenarios.ImportedMotions
  scenarios.SensorLatency scenarios.StanceLoop scenarios.ViipHoap1 sim.Walking study.Certify
  study.LocalRetime study.Push study.Retime study.SequentialTest)
