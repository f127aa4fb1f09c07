// Generated from docs/openapi.json by `npm run generate`. Do not edit.

export interface paths {
    "/api/v1/alarms": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * List Alarms
         * @description Alarms of all rigs, newest first by their first occurrence, a page at a time; all of them outlive restarts.
         */
        get: operations["list_alarms_api_v1_alarms_get"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/alive": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Alive
         * @description Whether the server answers, and does well: for who looks after it from outside, and need not sign in.
         */
        get: operations["alive_api_v1_alive_get"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/audit": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * List Audit
         * @description Every command and every change, accepted or refused, newest first, a page at a time.
         */
        get: operations["list_audit_api_v1_audit_get"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/compare": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * List Comparisons
         * @description Comparisons, newest first, a page at a time, without their reports.
         */
        get: operations["list_comparisons_api_v1_compare_get"];
        put?: never;
        /**
         * Add Comparison
         * @description Ask for a comparison at the rig's own rate; poll it until its status is done, failed or cancelled.
         */
        post: operations["add_comparison_api_v1_compare_post"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/compare/{comparison}": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Get Comparison
         * @description One comparison, how far it is, and its report once it is done.
         */
        get: operations["get_comparison_api_v1_compare__comparison__get"];
        put?: never;
        post?: never;
        /**
         * Remove Comparison
         * @description Cancel a comparison that is being made (it stays, cancelled); remove one that is not.
         */
        delete: operations["remove_comparison_api_v1_compare__comparison__delete"];
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/compare/{comparison}/page": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Comparison Page
         * @description Table and plots as one self-contained HTML page.
         */
        get: operations["comparison_page_api_v1_compare__comparison__page_get"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/exports": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * List Exports
         * @description The kinds of file that plans and runs are exported as, and which of them this server has the library for.
         */
        get: operations["list_exports_api_v1_exports_get"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/health": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Health
         * @description How the server, its planner and its rigs do. Always 200: `status` and `warnings` say what is wrong.
         */
        get: operations["health_api_v1_health_get"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/login": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get?: never;
        put?: never;
        /**
         * Login
         * @description Sign in: the answer sets the session's cookie. The name may be spelled in any capitals.
         */
        post: operations["login_api_v1_login_post"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/login/provider": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Leave
         * @description Send a browser to the provider.
         */
        get: operations["leave_api_v1_login_provider_get"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/login/provider/answer": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Arrive
         * @description A browser that the provider sent back: signed in, and at the console.
         */
        get: operations["arrive_api_v1_login_provider_answer_get"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/logout": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get?: never;
        put?: never;
        /**
         * Logout
         * @description Sign out: the session ends, everywhere at once. A token is revoked elsewhere.
         */
        post: operations["logout_api_v1_logout_post"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/me": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Me
         * @description Whether one must sign in here, and who one is.
         */
        get: operations["me_api_v1_me_get"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/me/password": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get?: never;
        /**
         * Change Password
         * @description Change one's own password: every other session of one's own ends, and every other token where it is asked for.
         */
        put: operations["change_password_api_v1_me_password_put"];
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/methods": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * List Methods
         * @description The methods that plans, solves and comparisons may name.
         */
        get: operations["list_methods_api_v1_methods_get"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/metrics": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Metrics
         * @description Prometheus text.
         */
        get: operations["metrics_api_v1_metrics_get"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/plans": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * List Plans
         * @description Plans, newest first, a page at a time; all, or those that are searched for, by what is their flight's too.
         */
        get: operations["list_plans_api_v1_plans_get"];
        put?: never;
        /**
         * Add Plan
         * @description Ask for a plan; poll it until its status is done, failed or cancelled.
         */
        post: operations["add_plan_api_v1_plans_post"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/plans/{plan}": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Get Plan
         * @description One plan and how far it is.
         */
        get: operations["get_plan_api_v1_plans__plan__get"];
        put?: never;
        post?: never;
        /**
         * Remove Plan
         * @description Cancel a plan that is being made (it stays, cancelled); remove one that is not.
         */
        delete: operations["remove_plan_api_v1_plans__plan__delete"];
        options?: never;
        head?: never;
        /**
         * Label Plan
         * @description Put tags and notes to a plan; its hash, and what it flies, stay as they are.
         */
        patch: operations["label_plan_api_v1_plans__plan__patch"];
        trace?: never;
    };
    "/api/v1/plans/{plan}/export": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Export Plan
         * @description The whole plan as a file: what is flown at the rig's rate, leads included, every sample.
         */
        get: operations["export_plan_api_v1_plans__plan__export_get"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/plans/{plan}/plane": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Plan Plane
         * @description The plane of time and base angle of a plan: the share of the limits that a path can leave at most, the needles,
         *     the plan's own path and where it is tightest. Of a plan that is not feasible the map is the flight's.
         */
        get: operations["plan_plane_api_v1_plans__plan__plane_get"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/plans/{plan}/remedies": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get?: never;
        put?: never;
        /**
         * Add Remedy
         * @description Search what would make this plan's flight fit its rig: a plan of its own, with progress and cancel as any other.
         *
         *     It is planned with method plan. What was changed is in its `remedy`; it can be loaded like the rest, but for a
         *     relaxed limit, which the rig must be given first.
         */
        post: operations["add_remedy_api_v1_plans__plan__remedies_post"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/plans/{plan}/samples": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Plan Samples
         * @description Angles, rates, accelerations and error of a plan, thinned to about `points` samples, for plots.
         */
        get: operations["plan_samples_api_v1_plans__plan__samples_get"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/profiles": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * List Profiles
         * @description All profiles, those that ship first.
         */
        get: operations["list_profiles_api_v1_profiles_get"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/profiles/{name}": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get?: never;
        /**
         * Save Profile
         * @description Save a column map under a name, by which an upload may ask for it.
         */
        put: operations["save_profile_api_v1_profiles__name__put"];
        post?: never;
        /**
         * Remove Profile
         * @description Remove a saved profile. Flights that were read by it stay.
         */
        delete: operations["remove_profile_api_v1_profiles__name__delete"];
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/reading": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get?: never;
        put?: never;
        /**
         * Read File
         * @description Look at a file and store nothing: its first rows, what its columns are taken for, and the flight that makes.
         */
        post: operations["read_file_api_v1_reading_post"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/rigs": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * List Rigs
         * @description All rigs, the built-in ones first.
         */
        get: operations["list_rigs_api_v1_rigs_get"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/rigs/{rig}": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Get Rig
         * @description One rig.
         */
        get: operations["get_rig_api_v1_rigs__rig__get"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/rigs/{rig}/alarms": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Get Alarms
         * @description The rig's alarms, standing and past, the newest last.
         */
        get: operations["get_alarms_api_v1_rigs__rig__alarms_get"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/rigs/{rig}/commands": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get?: never;
        put?: never;
        /**
         * Command
         * @description Command the session. Needs the lease and an operator, but for stop and estop.
         */
        post: operations["command_api_v1_rigs__rig__commands_post"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/rigs/{rig}/estop": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get?: never;
        put?: never;
        /**
         * Estop
         * @description Brake as fast as the limits allow, then disable the drive (IEC 60204-1 category 1). No lease; waits for nothing.
         *
         *     It is no safety function: the hardware chain beside the rig is.
         */
        post: operations["estop_api_v1_rigs__rig__estop_post"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/rigs/{rig}/lease": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get?: never;
        put?: never;
        /**
         * Lease
         * @description Take, request, grant, renew or release the lease. Who has its secret holds it, and where people sign in it is
         *     that person's alone.
         */
        post: operations["lease_api_v1_rigs__rig__lease_post"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/rigs/{rig}/scene/pose": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get?: never;
        put?: never;
        /**
         * Show Pose
         * @description Show an instant of a plan as a ghost beside the rig, to all who look; null takes it away. Needs no lease.
         */
        post: operations["show_pose_api_v1_rigs__rig__scene_pose_post"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/rigs/{rig}/session": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Get Session
         * @description The session as of now.
         */
        get: operations["get_session_api_v1_rigs__rig__session_get"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/rigs/{rig}/stop": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get?: never;
        put?: never;
        /**
         * Stop
         * @description Brake every frame inside its limits (IEC 60204-1 category 2). Needs no lease and waits for no other command.
         */
        post: operations["stop_api_v1_rigs__rig__stop_post"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/runs": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * List Runs
         * @description Runs and incidents, newest first, a page at a time; a record that cannot be read is listed with its error.
         *
         *     Searched for by id, rig, who flew it, how it ended, notes and tags, and by what is their plan's or its flight's.
         */
        get: operations["list_runs_api_v1_runs_get"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/runs/{run}": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Get Run
         * @description One run.
         */
        get: operations["get_run_api_v1_runs__run__get"];
        put?: never;
        post?: never;
        /**
         * Remove Run
         * @description Remove a run that is neither pinned nor being written.
         */
        delete: operations["remove_run_api_v1_runs__run__delete"];
        options?: never;
        head?: never;
        /**
         * Label Run
         * @description Put tags and notes to a run; its record stays as it is.
         */
        patch: operations["label_run_api_v1_runs__run__patch"];
        trace?: never;
    };
    "/api/v1/runs/{run}/curves": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Run Curves
         * @description What there is to draw of a run, and what happened in it. Made of its record when first asked for.
         */
        get: operations["run_curves_api_v1_runs__run__curves_get"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/runs/{run}/curves/window": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Curves Window
         * @description A window of the curves, or of the difference, as `schemas.curves` describes it: least and greatest by bucket.
         */
        get: operations["curves_window_api_v1_runs__run__curves_window_get"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/runs/{run}/evidence": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Run Evidence
         * @description Everything that the run was as one signed file, which `fullpose evidence verify` proves without this server.
         */
        get: operations["run_evidence_api_v1_runs__run__evidence_get"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/runs/{run}/export": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Export Run
         * @description The whole run as a file: every sample of the record; as MCAP always with an index, repaired where need be.
         */
        get: operations["export_run_api_v1_runs__run__export_get"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/runs/{run}/pin": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get?: never;
        /**
         * Pin Run
         * @description Keep a run: retention passes it over, and it cannot be deleted.
         */
        put: operations["pin_run_api_v1_runs__run__pin_put"];
        post?: never;
        /**
         * Unpin Run
         * @description Keep it no longer than any other.
         */
        delete: operations["unpin_run_api_v1_runs__run__pin_delete"];
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/solve": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get?: never;
        put?: never;
        /**
         * Solve Batch
         * @description A batch of attitudes in, frame angles and errors out; no session needed.
         */
        post: operations["solve_batch_api_v1_solve_post"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/tokens": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * List Tokens
         * @description One's own, newest first; an admin sees everybody's.
         */
        get: operations["list_tokens_api_v1_tokens_get"];
        put?: never;
        /**
         * Make Token
         * @description A token of one's own, of at most one's own role. One that is made by a token ends with it at the latest.
         */
        post: operations["make_token_api_v1_tokens_post"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/tokens/{token}": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get?: never;
        put?: never;
        post?: never;
        /**
         * Revoke Token
         * @description End a token of one's own, or as an admin anybody's: in force at once, on open connections too.
         */
        delete: operations["revoke_token_api_v1_tokens__token__delete"];
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/trajectories": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * List Trajectories
         * @description Flights, newest first, a page at a time; all, or those that are searched for.
         */
        get: operations["list_trajectories_api_v1_trajectories_get"];
        put?: never;
        /**
         * Add Trajectory
         * @description Upload a flight. Refused as a whole where anything in it is wrong; the problem names line and column.
         */
        post: operations["add_trajectory_api_v1_trajectories_post"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/trajectories/{sha256}": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Get Trajectory
         * @description One flight.
         */
        get: operations["get_trajectory_api_v1_trajectories__sha256__get"];
        put?: never;
        post?: never;
        /**
         * Remove Trajectory
         * @description Remove a flight that no plan needs.
         */
        delete: operations["remove_trajectory_api_v1_trajectories__sha256__delete"];
        options?: never;
        head?: never;
        /**
         * Label Trajectory
         * @description Put tags and notes to a flight, which stays what it is.
         */
        patch: operations["label_trajectory_api_v1_trajectories__sha256__patch"];
        trace?: never;
    };
    "/api/v1/trajectories/{sha256}/diagnosis": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Diagnose Trajectory
         * @description What the flight is made of and what is wrong with it: noise, rounding, holds, stamps, gaps, outliers, each with a
         *     figure; with `rig`, what the noise costs its frames.
         */
        get: operations["diagnose_trajectory_api_v1_trajectories__sha256__diagnosis_get"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/trajectories/{sha256}/preview": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Preview Trajectory
         * @description The flight thinned to about `points` samples, for plots.
         */
        get: operations["preview_trajectory_api_v1_trajectories__sha256__preview_get"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/trajectories/{sha256}/tolerance": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Tolerance Of Trajectory
         * @description What a tolerance does to the flight: deviation and body accelerations. Without one, the one that is suggested.
         */
        get: operations["tolerance_of_trajectory_api_v1_trajectories__sha256__tolerance_get"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/users": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * List Users
         * @description Everybody, by name.
         */
        get: operations["list_users_api_v1_users_get"];
        put?: never;
        /**
         * Add User
         * @description A new person.
         */
        post: operations["add_user_api_v1_users_post"];
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/users/{name}": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        get?: never;
        /**
         * Change User
         * @description Another role, another password, shut out or let in again: in force at once, on open connections too.
         */
        put: operations["change_user_api_v1_users__name__put"];
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
    "/api/v1/version": {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        /**
         * Version
         * @description What runs here, and what it speaks.
         */
        get: operations["version_api_v1_version_get"];
        put?: never;
        post?: never;
        delete?: never;
        options?: never;
        head?: never;
        patch?: never;
        trace?: never;
    };
}
export type webhooks = Record<string, never>;
export interface components {
    schemas: {
        /** Acknowledge */
        Acknowledge: {
            /** @default {} */
            args: components["schemas"]["AcknowledgeArgs"];
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            command: "acknowledge";
            lease?: components["schemas"]["LeaseToken"] | null;
        };
        /** AcknowledgeArgs */
        AcknowledgeArgs: {
            /**
             * Numbers
             * @description Of alarms; null: all that stand
             */
            numbers?: number[] | null;
        };
        /**
         * AlarmOut
         * @description A fault or warning, with its evidence; `value` and `limit` are in `unit`. `first` of a chain is its cause.
         */
        AlarmOut: {
            /** Acknowledged By */
            acknowledged_by?: string | null;
            /**
             * Acknowledged S
             * @description Seconds since 1970, of that
             */
            acknowledged_s?: number | null;
            /** Code */
            code: string;
            /**
             * Count
             * @default 1
             */
            count: number;
            /**
             * First
             * @default false
             */
            first: boolean;
            /** Frame */
            frame?: ("base" | "outer" | "middle" | "inner") | null;
            /**
             * Last Time S
             * @description Of the newest occurrence, where there was more than one
             */
            last_time_s?: number | null;
            /** Limit */
            limit?: number | null;
            /** Message */
            message: string;
            /** Number */
            number: number;
            severity: components["schemas"]["Severity"];
            /**
             * Shelved
             * @description It was raised while shelved: it never stood
             * @default false
             */
            shelved: boolean;
            /**
             * Time S
             * @description Seconds since 1970, of the first occurrence
             */
            time_s: number;
            /** Unit */
            unit?: string | null;
            /** Value */
            value?: number | null;
        };
        /**
         * AlarmRecordOut
         * @description An alarm of the history; `number` is its process's count, `id` its own over all restarts.
         */
        AlarmRecordOut: {
            /** Acknowledged By */
            acknowledged_by?: string | null;
            /**
             * Acknowledged S
             * @description Seconds since 1970, of that
             */
            acknowledged_s?: number | null;
            /** Code */
            code: string;
            /**
             * Count
             * @default 1
             */
            count: number;
            /**
             * First
             * @default false
             */
            first: boolean;
            /** Frame */
            frame?: ("base" | "outer" | "middle" | "inner") | null;
            /** Id */
            id: string;
            /**
             * Last Time S
             * @description Of the newest occurrence, where there was more than one
             */
            last_time_s?: number | null;
            /** Limit */
            limit?: number | null;
            /** Message */
            message: string;
            /** Number */
            number: number;
            /** Rig */
            rig: string;
            severity: components["schemas"]["Severity"];
            /**
             * Shelved
             * @description It was raised while shelved: it never stood
             * @default false
             */
            shelved: boolean;
            /**
             * Standing
             * @description Whether it stands now
             */
            standing: boolean;
            /**
             * Time S
             * @description Seconds since 1970, of the first occurrence
             */
            time_s: number;
            /** Unit */
            unit?: string | null;
            /** Value */
            value?: number | null;
        };
        /**
         * AliveOut
         * @description The server answers; how it does is in /health, for those who are signed in.
         */
        AliveOut: {
            /**
             * Dead
             * @description What of the server's own processes does not live; `status` may be degraded for other reasons too
             */
            dead: ("planner" | "rig" | "recorder")[];
            /**
             * Status
             * @enum {string}
             */
            status: "ok" | "degraded";
        };
        /**
         * AngleUnit
         * @description What an angle counts.
         * @enum {string}
         */
        AngleUnit: "deg" | "rad" | "centideg";
        /** Arm */
        Arm: {
            /** @default {} */
            args: components["schemas"]["ArmArgs"];
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            command: "arm";
            lease?: components["schemas"]["LeaseToken"] | null;
        };
        /**
         * ArmArgs
         * @description The pair that the caller means to arm; refused where another one is loaded.
         */
        ArmArgs: {
            /** Plan Hash */
            plan_hash?: string | null;
            /** Rig Hash */
            rig_hash?: string | null;
        };
        /**
         * AuditOut
         * @description One command, accepted or refused, or another change: of a flight, plan, comparison or record.
         */
        AuditOut: {
            /** Accepted */
            accepted: boolean;
            /**
             * Address
             * @description Where it came from, as the server sees it; null: not known
             */
            address: string | null;
            /** Args */
            args: {
                [key: string]: unknown;
            };
            /**
             * At
             * Format: date-time
             */
            at: string;
            /**
             * Command
             * @description Of a session; or what was done else, as method and path
             */
            command: string;
            /** Detail */
            detail: string | null;
            /**
             * Hash
             * @description sha-256 of this line and of `previous`: `fullpose audit verify` proves them
             */
            hash: string;
            /** Id */
            id: number;
            /** Lease Epoch */
            lease_epoch: number | null;
            /** Lease Sequence */
            lease_sequence: number | null;
            /**
             * Previous
             * @description The hash of the line before; of the first, zeros
             */
            previous: string;
            /**
             * Rig
             * @description Null: it is no rig's, but about people, or a flight, plan, comparison or record
             */
            rig: string | null;
            state_after: components["schemas"]["State"] | null;
            /** @description Null: of no session */
            state_before: components["schemas"]["State"] | null;
            /** Who */
            who: string;
        };
        /** BlockingOut */
        BlockingOut: {
            /**
             * Frame
             * @enum {string}
             */
            frame: "base" | "outer" | "middle" | "inner";
            /**
             * Limit
             * @enum {string}
             */
            limit: "position" | "rate" | "acceleration" | "jerk";
            /** Time S */
            time_s: number;
        };
        /**
         * BodyPeakOut
         * @description The largest of a vector, and about each body axis, with times.
         */
        BodyPeakOut: {
            /** Axes */
            axes: [
                number,
                number,
                number
            ];
            /** Axes Time S */
            axes_time_s: [
                number,
                number,
                number
            ];
            /** Max */
            max: number;
            /** Time S */
            time_s: number;
        };
        /**
         * BodyPeaks
         * @description The body's largest rate and acceleration, by differences of the samples.
         */
        BodyPeaks: {
            /** Acceleration Deg S2 */
            acceleration_deg_s2: number;
            /** Rate Deg S */
            rate_deg_s: number;
        };
        /**
         * Certainty
         * @description How sure a verdict is.
         * @enum {string}
         */
        Certainty: "checked" | "grid_complete" | "evidence" | "complete";
        /**
         * ColumnMap
         * @description What the columns of a table are.
         */
        ColumnMap: {
            axes: components["schemas"]["Convention"];
            euler?: components["schemas"]["EulerMap"] | null;
            quaternion?: components["schemas"]["QuaternionMap"] | null;
            time: components["schemas"]["TimeMap"];
        };
        /**
         * CommandDone
         * @description A command that was accepted, and what it gave.
         */
        CommandDone: {
            /** Command */
            command: string;
            /**
             * Live Key
             * @description Of load with live: what the source proves itself by, told here once; a later load gives another
             */
            live_key?: string | null;
            /** Revision */
            revision: number;
            state_after: components["schemas"]["State"];
            state_before: components["schemas"]["State"];
            /**
             * Stop Category
             * @description Of stop and estop, IEC 60204-1: 1, stopped under control, then power off; 2, power stays on. No safety function
             */
            stop_category?: (1 | 2) | null;
            /**
             * Unknown
             * @description Of stop and estop, with 202: the order was given, and this is not known of what came of it
             */
            unknown?: string | null;
        };
        /**
         * CommandOut
         * @description A command that was accepted: what the session was and is.
         */
        CommandOut: {
            /** Command */
            command: string;
            /** Revision */
            revision: number;
            state_after: components["schemas"]["State"];
            state_before: components["schemas"]["State"];
            /**
             * Stop Category
             * @description Of stop and estop, IEC 60204-1: 1, stopped under control, then power off; 2, power stays on. No safety function
             */
            stop_category?: (1 | 2) | null;
            /**
             * Unknown
             * @description Of stop and estop, with 202: the order was given, and this is not known of what came of it
             */
            unknown?: string | null;
        };
        /**
         * CompareIn
         * @description What to compare; in a text, options come after colons: alm:mode=open_loop.
         *
         *     Without `start_deg` every method starts at its own choice of pose.
         */
        CompareIn: {
            /** Methods */
            methods: (string | components["schemas"]["MethodIn"])[];
            /** Rig */
            rig: string;
            /** Start Deg */
            start_deg?: [
                number,
                number,
                number,
                number
            ] | null;
            /**
             * Tolerance Deg
             * @description Every method is given the flight within it
             */
            tolerance_deg?: number | null;
            /** Trajectory */
            trajectory: string;
        };
        /**
         * ComparisonOut
         * @description A comparison and its job; once it is done, its report and the path of its page.
         */
        ComparisonOut: {
            /**
             * Created At
             * Format: date-time
             */
            created_at: string;
            error: components["schemas"]["JobErrorOut"] | null;
            /** Id */
            id: string;
            /**
             * Methods
             * @description Their labels
             */
            methods: string[];
            /**
             * Page
             * @description Path of the page with table and plots
             */
            page: string | null;
            progress: components["schemas"]["ProgressOut"];
            /** Rate Hz */
            rate_hz: number;
            report: components["schemas"]["ComparisonReportOut"] | null;
            /** Rig */
            rig: string;
            status: components["schemas"]["JobStatus"];
            /** Trajectory */
            trajectory: string;
            /** Trajectory Name */
            trajectory_name: string;
        };
        /**
         * ComparisonReportOut
         * @description The report of `fullpose compare --report`, key by key; keys may be added, not renamed.
         */
        ComparisonReportOut: {
            deviation_deg?: components["schemas"]["DeviationOut"] | null;
            /** Duration S */
            duration_s: number;
            /** Exact Within Deg */
            exact_within_deg: number;
            /** Flight */
            flight: string;
            /** Geometry */
            geometry: string;
            /** Methods */
            methods: components["schemas"]["MethodFiguresOut"][];
            /** Resampling */
            resampling: string | null;
            /** Rig */
            rig: string;
            /** Samples */
            samples: number;
            /** Schema */
            schema: string;
            /** Smoothing */
            smoothing?: string | null;
            /** Suggested Tolerance Deg */
            suggested_tolerance_deg?: number | null;
            /** Tolerance Deg */
            tolerance_deg?: number | null;
            /** Tolerance Floor Deg */
            tolerance_floor_deg?: number | null;
        };
        /** Connect */
        Connect: {
            /** @default {} */
            args: components["schemas"]["NoArgs"];
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            command: "connect";
            lease?: components["schemas"]["LeaseToken"] | null;
        };
        /**
         * Consequence
         * @description What the attitude asks for once a frame has reached its limit.
         * @enum {string}
         */
        Consequence: "another_frame" | "same_frame" | "not_named";
        /**
         * Convention
         * @description The axes an attitude was written in (mathematics, section 1).
         * @enum {string}
         */
        Convention: "nue" | "ned" | "enu";
        /**
         * CurveEvent
         * @description What happened in a run, to be found on the time axis.
         */
        CurveEvent: {
            /**
             * At S
             * @description After the first sample
             */
            at_s: number;
            /**
             * Kind
             * @enum {string}
             */
            kind: "command" | "alarm" | "transition" | "begin" | "end" | "gap";
            /**
             * Severity
             * @description Of an alarm
             */
            severity: ("fault" | "warning") | null;
            /** Text */
            text: string;
        };
        /**
         * CurvesOut
         * @description The curves of a run, or how far they are from being made.
         */
        CurvesOut: {
            against: components["schemas"]["DifferenceOut"] | null;
            /** Columns */
            columns: string[];
            /** Duration S */
            duration_s: number;
            /** Events */
            events: components["schemas"]["CurveEvent"][];
            /**
             * Events Left Out
             * @description How many later ones there are than are listed
             */
            events_left_out: number;
            /**
             * Progress
             * @description What part of them is made, 0 to 1: ask again until they are ready
             */
            progress: number;
            /** Ready */
            ready: boolean;
            /**
             * Record Sha256
             * @description Of the record that they were made of
             */
            record_sha256: string | null;
            /** Samples */
            samples: number;
            /**
             * Started
             * @description Seconds since 1970, of the first sample
             */
            started: number | null;
        };
        /**
         * DeviationOut
         * @description By how much the flight that is flown differs from the samples as they were given.
         */
        DeviationOut: {
            /** Max */
            max: number;
            /** Rms */
            rms: number;
        };
        /**
         * DiagnosisOut
         * @description What a flight is made of and what is wrong with it.
         */
        DiagnosisOut: {
            body_acceleration_deg_s2: components["schemas"]["BodyPeakOut"];
            body_rate_deg_s: components["schemas"]["BodyPeakOut"];
            /** Duration S */
            duration_s: number;
            /**
             * Findings
             * @description Warnings first
             */
            findings: components["schemas"]["Finding"][];
            /** Gap Count */
            gap_count: number;
            /**
             * Gaps
             * @description The first 100
             */
            gaps: components["schemas"]["GapOut"][];
            held: components["schemas"]["HeldOut"] | null;
            /** Near Duplicate Samples */
            near_duplicate_samples: number;
            /**
             * Near Duplicates
             * @description The first 100
             */
            near_duplicates: components["schemas"]["NearDuplicate"][];
            /**
             * Noise Acceleration Deg S2
             * @description What noise or rounding alone costs the body
             */
            noise_acceleration_deg_s2: [
                number,
                number,
                number
            ];
            /** Noise Measured */
            noise_measured: boolean;
            /** Outlier Samples */
            outlier_samples: number;
            /**
             * Outliers
             * @description The first 100
             */
            outliers: components["schemas"]["OutlierOut"][];
            plots: components["schemas"]["DiagnosisPlots"];
            quantum: components["schemas"]["QuantumOut"] | null;
            rig: components["schemas"]["RigCost"] | null;
            /** Samples */
            samples: number;
            stamps: components["schemas"]["StampsOut"];
            step_s: components["schemas"]["StepsOut"];
            /**
             * White Noise Deg
             * @description Standard deviation per body axis
             */
            white_noise_deg: [
                number,
                number,
                number
            ];
        };
        /**
         * DiagnosisPlots
         * @description What the console draws.
         */
        DiagnosisPlots: {
            noise: components["schemas"]["NoisePlot"];
            steps: components["schemas"]["StepsPlot"];
        };
        /**
         * DifferenceOut
         * @description What a run is compared with. `time_s` is the run's, of the reference's samples those of the same moment.
         */
        DifferenceOut: {
            /**
             * Aligned
             * @description By the time of the flight; or, where one of both has none, by the time since it began to run
             * @enum {string}
             */
            aligned: "flight" | "run";
            /** Columns */
            columns: string[];
            /** Id */
            id: string;
            /**
             * Kind
             * @enum {string}
             */
            kind: "run" | "plan";
            /**
             * Turned Deg
             * @description Whole revolutions by which the reference was moved, by frame
             */
            turned_deg: number[];
        };
        /** Disarm */
        Disarm: {
            /** @default {} */
            args: components["schemas"]["NoArgs"];
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            command: "disarm";
            lease?: components["schemas"]["LeaseToken"] | null;
        };
        /**
         * DiskOut
         * @description The data folder's disk.
         */
        DiskOut: {
            /**
             * Alarm Bytes
             * @description Less than that free: health is degraded
             */
            alarm_bytes: number;
            /** Free Bytes */
            free_bytes: number;
        };
        /**
         * DriveTimes
         * @description How long the drive's calls take: smoothed, and the longest since its process began.
         */
        DriveTimes: {
            /**
             * Hangs
             * @description The call that has not returned, while the loop does not respond
             */
            hangs: string | null;
            /** Read Max Us */
            read_max_us: number;
            /** Read Us */
            read_us: number;
            /** Write Max Us */
            write_max_us: number;
            /** Write Us */
            write_us: number;
        };
        /**
         * Epoch
         * @description Where the flight's time begins.
         * @enum {string}
         */
        Epoch: "file" | "first";
        /** Estop */
        Estop: {
            /** @default {} */
            args: components["schemas"]["NoArgs"];
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            command: "estop";
            lease?: components["schemas"]["LeaseToken"] | null;
        };
        /**
         * EulerMap
         * @description Three turns about the body's own axes, one after the other; the axes are those of `axes`.
         */
        EulerMap: {
            /** Columns */
            columns: [
                string,
                string,
                string
            ];
            /**
             * Order
             * @enum {string}
             */
            order: "XYZ" | "XZY" | "YXZ" | "YZX" | "ZXY" | "ZYX" | "XYX" | "XZX" | "YXY" | "YZY" | "ZXZ" | "ZYZ";
            /** @default deg */
            unit: components["schemas"]["AngleUnit"];
        };
        /**
         * ExportKind
         * @description The kinds, each by the ending of its files.
         * @enum {string}
         */
        ExportKind: "csv" | "parquet" | "mcap" | "mat" | "tdms" | "mf4" | "f64";
        /**
         * ExportKindOut
         * @description A kind of file.
         */
        ExportKindOut: {
            /**
             * Available
             * @description False: this server is without the library that it takes
             */
            available: boolean;
            /** @description What `export` is asked for, and the ending of the file */
            format: components["schemas"]["ExportKind"];
            /**
             * Install
             * @description What to type on the server for that library; null: it needs none
             */
            install: string | null;
            /**
             * Label
             * @description What people call it
             */
            label: string;
        };
        /**
         * FailureOut
         * @description Samples that miss the attitude for one reason.
         */
        FailureOut: {
            /** First S */
            first_s: number;
            /** Max Error Deg */
            max_error_deg: number | null;
            /** Reason */
            reason: string;
            /** Samples */
            samples: number;
        };
        /**
         * FieldProblem
         * @description One thing wrong with a request: where, which value, what was expected.
         */
        FieldProblem: {
            /** Expected */
            expected?: string | null;
            /**
             * Line
             * @description Line of the file, the first is 1
             */
            line?: number | null;
            /** Message */
            message: string;
            /** Value */
            value?: string | null;
            /**
             * Where
             * @description Path in the body, query or header, or the column of a file
             */
            where: string;
        };
        /**
         * Finding
         * @description One thing found, as a sentence with its figure.
         */
        Finding: {
            /** Code */
            code: string;
            /**
             * Level
             * @enum {string}
             */
            level: "warning" | "remark";
            /** Sentence */
            sentence: string;
        };
        /**
         * FrameCost
         * @description What the noise costs a frame, beside its limits.
         */
        FrameCost: {
            /** Max Acceleration Deg S2 */
            max_acceleration_deg_s2: number | null;
            /** Max Rate Deg S */
            max_rate_deg_s: number | null;
            noise_acceleration_deg_s2: components["schemas"]["NoiseCost"];
        };
        /**
         * FrameMargins
         * @description Null: no limit. deg, deg/s, deg/s^2, deg/s^3.
         */
        FrameMargins: {
            acceleration_deg_s2: components["schemas"]["MarginOut"] | null;
            jerk_deg_s3?: components["schemas"]["MarginOut"] | null;
            position_deg: components["schemas"]["MarginOut"] | null;
            rate_deg_s: components["schemas"]["MarginOut"] | null;
        };
        /**
         * FrameOut
         * @description One frame's limits; null means no limit. Both positions null: the frame turns without end.
         */
        FrameOut: {
            /** Home Deg */
            home_deg: number;
            /** Max Acceleration Deg S2 */
            max_acceleration_deg_s2: number | null;
            /** Max Deg */
            max_deg: number | null;
            /** Max Jerk Deg S3 */
            max_jerk_deg_s3: number | null;
            /** Max Rate Deg S */
            max_rate_deg_s: number | null;
            /** Min Deg */
            min_deg: number | null;
            /** Weight */
            weight: number;
        };
        /**
         * FramesOut
         * @description The frames from the outside in; a three-axis rig has no base.
         */
        FramesOut: {
            base: components["schemas"]["FrameOut"] | null;
            inner: components["schemas"]["FrameOut"];
            middle: components["schemas"]["FrameOut"];
            outer: components["schemas"]["FrameOut"];
        };
        /**
         * GapOut
         * @description A time without samples.
         */
        GapOut: {
            /** End S */
            end_s: number;
            /** Start S */
            start_s: number;
            /**
             * Steps
             * @description In median steps of its neighbours
             */
            steps: number;
        };
        /** GoLive */
        GoLive: {
            /** @default {} */
            args: components["schemas"]["NoArgs"];
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            command: "go_live";
            lease?: components["schemas"]["LeaseToken"] | null;
        };
        /**
         * HealthOut
         * @description `status` is degraded where a rig process, a recorder or the planner does not answer, a rig file is none, the disk
         *     is nearly full, or something stored was damaged.
         */
        HealthOut: {
            /**
             * Authenticated
             * @description Whether one must sign in; else anyone who reaches the port may command
             */
            authenticated: boolean;
            disk: components["schemas"]["DiskOut"];
            limits: components["schemas"]["ServerLimits"];
            planner: components["schemas"]["RunnerStatus"];
            /** Rigs */
            rigs: {
                [key: string]: components["schemas"]["RigHealth"];
            };
            /** Server Time */
            server_time: number;
            /**
             * Status
             * @enum {string}
             */
            status: "ok" | "degraded";
            /** Uptime S */
            uptime_s: number;
            /** Version */
            version: string;
            /** Warnings */
            warnings: string[];
        };
        /**
         * HeldOut
         * @description Samples that repeat the one before although the flight moves.
         */
        HeldOut: {
            /**
             * Length
             * @description Samples a run, on average, where the flight is held at one rate; else 1
             */
            length: number;
            /** Rate Hz */
            rate_hz: number | null;
            /** Samples */
            samples: number;
        };
        /**
         * Hello
         * @description First message of the server. `replay` is null where a rig is streamed as it lives.
         */
        Hello: {
            /** Fields */
            fields: string[];
            record: components["schemas"]["Record"];
            /** @default null */
            replay: components["schemas"]["ReplayOf"] | null;
            /** Rig */
            rig: string;
            /**
             * Schema
             * @default fullpose.stream/1
             * @constant
             */
            schema: "fullpose.stream/1";
            /** Server Time */
            server_time: number;
            session: components["schemas"]["SessionOut"];
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            type: "hello";
        };
        /** Hold */
        Hold: {
            /** @default {} */
            args: components["schemas"]["NoArgs"];
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            command: "hold";
            lease?: components["schemas"]["LeaseToken"] | null;
        };
        /** Home */
        Home: {
            /** @default {} */
            args: components["schemas"]["NoArgs"];
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            command: "home";
            lease?: components["schemas"]["LeaseToken"] | null;
        };
        /**
         * InputOut
         * @description What was taken of a file, and what is doubtful about it.
         */
        InputOut: {
            /**
             * Convention
             * @enum {string}
             */
            convention: "nue" | "ned" | "enu";
            /** Format */
            format: string;
            /**
             * Profile
             * @description The named profile; empty where the columns were given
             */
            profile: string;
            /**
             * Statement
             * @description Columns, units, order, sense, axes and clock, in words
             */
            statement: string;
            /**
             * Table
             * @description Of a file that has several; empty otherwise
             */
            table: string;
            /** Warnings */
            warnings: components["schemas"]["Notice"][];
        };
        /** IterationsOut */
        IterationsOut: {
            /** Max */
            max: number;
            /** Median */
            median: number;
        };
        /**
         * JobErrorOut
         * @description Why a job failed.
         */
        JobErrorOut: {
            /** Code */
            code: string;
            /**
             * Errors
             * @default []
             */
            errors: components["schemas"]["FieldProblem"][];
            /** Message */
            message: string;
        };
        /**
         * JobStatus
         * @description Of a plan or a comparison.
         * @enum {string}
         */
        JobStatus: "queued" | "running" | "done" | "failed" | "cancelled" | "interrupted";
        /** Jog */
        Jog: {
            args: components["schemas"]["JogArgs"];
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            command: "jog";
            lease?: components["schemas"]["LeaseToken"] | null;
        };
        /**
         * JogArgs
         * @description One step of one frame, from where the rig is commanded to be.
         */
        JogArgs: {
            /**
             * Frame
             * @enum {string}
             */
            frame: "base" | "outer" | "middle" | "inner";
            /** Step Deg */
            step_deg: number;
        };
        /**
         * LabelsIn
         * @description In place of those that it has; what is left out stays as it is.
         */
        LabelsIn: {
            /**
             * Notes
             * @description Up to 4000 characters
             */
            notes?: string | null;
            /**
             * Tags
             * @description Up to 32 of 1 to 40 characters, without a comma; two that differ in capitals only are one
             */
            tags?: string[] | null;
        };
        /**
         * LeadsOut
         * @description The ways from rest to the first sample and from the last one to rest.
         */
        LeadsOut: {
            /** Lead In S */
            lead_in_s: number;
            /** Lead Out S */
            lead_out_s: number;
            /**
             * Refusal
             * @description Why there is none
             */
            refusal: string | null;
        };
        /**
         * LeaseGiven
         * @description The lease after an action. `secret` is the caller's alone: it is told here once, and nowhere else.
         */
        LeaseGiven: {
            /** Epoch */
            epoch: number;
            /**
             * Expires S
             * @description Until the holder counts as silent: the rig holds, stops, disarms
             */
            expires_s: number | null;
            /** Holder */
            holder: string | null;
            /** Requested By */
            requested_by: string[];
            /**
             * Secret
             * @description With take and takeover: the lease's. With request: the lease's once it is granted to the caller
             */
            secret?: string | null;
            /** Sequence */
            sequence: number;
        };
        /**
         * LeaseIn
         * @description take: when free or silent; takeover: by force, audited; request: ask the holder. Each answers a secret.
         *
         *     Under the lease's secret: renew; grant: hand over to who asked; release: give it up.
         */
        LeaseIn: {
            /**
             * Action
             * @default take
             * @enum {string}
             */
            action: "take" | "takeover" | "request" | "grant" | "renew" | "release";
            /**
             * Reason
             * @description With takeover: why, for the audit. Needed where people sign in
             */
            reason?: string | null;
            /**
             * Secret
             * @description The lease's; with renew, grant and release
             */
            secret?: string | null;
            /**
             * To
             * @description With grant: who of those who asked; null: the first
             */
            to?: string | null;
        };
        /**
         * LeaseOut
         * @description Who may command. `epoch` grows with every new holder; each command's sequence must be above `sequence`.
         */
        LeaseOut: {
            /** Epoch */
            epoch: number;
            /**
             * Expires S
             * @description Until the holder counts as silent: the rig holds, stops, disarms
             */
            expires_s: number | null;
            /** Holder */
            holder: string | null;
            /** Requested By */
            requested_by: string[];
            /** Sequence */
            sequence: number;
        };
        /**
         * LeaseToken
         * @description Proof of holding the lease: its secret, its epoch, and a sequence that grows with every command.
         */
        LeaseToken: {
            /** Epoch */
            epoch: number;
            /** Secret */
            secret: string;
            /** Sequence */
            sequence: number;
        };
        /**
         * Limited
         * @description A sample whose attitude a limit did not allow.
         */
        Limited: {
            /**
             * Frame
             * @enum {string}
             */
            frame: "base" | "outer" | "middle" | "inner";
            /**
             * Limit
             * @enum {string}
             */
            limit: "position" | "rate" | "acceleration" | "jerk";
            /** Sample */
            sample: number;
        };
        /**
         * LimitMetOut
         * @description A frame and one of its limits: `value` against `bound`, in deg, deg/s, deg/s^2 or deg/s^3 by the limit.
         */
        LimitMetOut: {
            /** Bound */
            bound: number;
            /**
             * Frame
             * @enum {string}
             */
            frame: "base" | "outer" | "middle" | "inner";
            /**
             * Limit
             * @enum {string}
             */
            limit: "position" | "rate" | "acceleration" | "jerk";
            /** Time S */
            time_s: number;
            /** Value */
            value: number;
        };
        /**
         * LiveLoad
         * @description How a live source is flown: a step method that keeps the limits, and its options.
         */
        LiveLoad: {
            /**
             * First Sample S
             * @description How long go_live waits for the source
             * @default 5
             */
            first_sample_s: number;
            /**
             * Method
             * @default exact
             */
            method: string;
            /**
             * Options
             * @default {}
             */
            options: {
                [key: string]: boolean | number | string;
            };
            /**
             * Udp From
             * @description Address and port, 127.0.0.1:7461, that the source sends from by UDP; null: it has the key
             */
            udp_from?: string | null;
        };
        LiveMessageIn: components["schemas"]["OpenLive"] | components["schemas"]["LiveSampleIn"];
        LiveMessageOut: components["schemas"]["LiveOpened"] | components["schemas"]["LiveReplyOut"] | components["schemas"]["LiveProblem"];
        /**
         * LiveOpened
         * @description The answer to open. What comes next is the session's: arm, go_live.
         */
        LiveOpened: {
            /**
             * Loaded
             * @description Whether the session has a live source loaded
             */
            loaded: boolean;
            /** Rate Hz */
            rate_hz: number;
            /** Rig */
            rig: string;
            state: components["schemas"]["State"];
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            type: "opened";
        };
        /**
         * LiveOut
         * @description The live source that is loaded.
         */
        LiveOut: {
            /** Accepted */
            accepted: number;
            /**
             * Age Ms
             * @description How far the attitude flown lies beyond the newest sample; negative: known ahead; null: not heard
             */
            age_ms: number | null;
            /**
             * Bad
             * @description No samples at all
             */
            bad: number;
            /**
             * Clock Steps
             * @description How often the source's clock began anew
             */
            clock_steps: number;
            /**
             * Dropped
             * @description Late, doubled or overtaken: not used
             */
            dropped: number;
            /**
             * Implausible
             * @description Beyond a plausible body rate: not used
             */
            implausible: number;
            /**
             * Rate Hz
             * @description Samples taken in the last second or so
             */
            rate_hz: number;
            /**
             * Unproven
             * @description Not of the source that was loaded: not used
             */
            unproven: number;
            /**
             * Way Age Ms
             * @description Since the preview's planner was heard; null: no such method
             */
            way_age_ms: number | null;
        };
        /**
         * LiveProblem
         * @description A message that was not used; the connection goes on, but where the rig process is gone.
         */
        LiveProblem: {
            problem: components["schemas"]["Problem"];
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            type: "problem";
        };
        /**
         * LiveReplyOut
         * @description What became of a sample; null is not a number: nothing is followed.
         *
         *     `error_deg`: angles commanded in the tick that took the sample, against the attitude flown then; `lag_deg`: against
         *     this very sample; `margin`: smallest relative distance to a limit; `latency_us`: in the rig process;
         *     `server_latency_us`: from the message's arrival at the server to this answer.
         */
        LiveReplyOut: {
            /** Angles Deg */
            angles_deg: number[];
            /** Error Deg */
            error_deg: number | null;
            /** Lag Deg */
            lag_deg: number | null;
            /** Latency Us */
            latency_us: number;
            /** Margin */
            margin: number | null;
            refused: components["schemas"]["SampleRefused"] | null;
            /**
             * Sequence
             * @description Counts the samples of this client, from 0
             */
            sequence: number;
            /** Server Latency Us */
            server_latency_us: number | null;
            /** Status */
            status: ("followed" | "limited" | "dropped" | "idle" | "implausible" | "unproven")[];
            /** Time S */
            time_s: number;
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            type: "reply";
        };
        /**
         * LiveSampleIn
         * @description One attitude: `q` (w, x, y, z) or `euler_deg`, as the convention says; body rates where the source has them.
         */
        LiveSampleIn: {
            /**
             * Body Rate Deg S
             * @default null
             */
            body_rate_deg_s: [
                number,
                number,
                number
            ] | null;
            /**
             * Euler Deg
             * @default null
             */
            euler_deg: [
                number,
                number,
                number
            ] | null;
            /**
             * Q
             * @default null
             */
            q: [
                number,
                number,
                number,
                number
            ] | null;
            /**
             * Time S
             * @description The source's clock, rising
             */
            time_s: number;
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            type: "sample";
        };
        /** Load */
        Load: {
            args: components["schemas"]["LoadArgs"];
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            command: "load";
            lease?: components["schemas"]["LeaseToken"] | null;
        };
        /**
         * LoadArgs
         * @description A plan, or a live source.
         */
        LoadArgs: {
            live?: components["schemas"]["LiveLoad"] | null;
            /**
             * Plan
             * @description Id of a flyable plan of this rig
             */
            plan?: string | null;
        };
        /** LoginIn */
        LoginIn: {
            /** Name */
            name: string;
            /** Password */
            password: string;
        };
        /**
         * MarginOut
         * @description The smallest distance to a limit, and when; negative beyond it.
         */
        MarginOut: {
            /** Time S */
            time_s: number;
            /** Value */
            value: number;
        };
        /**
         * MarginsOut
         * @description Of every frame; `singularity` is the smallest sin^2(outer) + cos^2(middle), zero at the rig's singularity.
         */
        MarginsOut: {
            base?: components["schemas"]["FrameMargins"] | null;
            inner: components["schemas"]["FrameMargins"];
            middle: components["schemas"]["FrameMargins"];
            outer: components["schemas"]["FrameMargins"];
            singularity: components["schemas"]["MarginOut"] | null;
        };
        /**
         * MeOut
         * @description What a console asks first.
         */
        MeOut: {
            /**
             * People
             * @description Whether one must sign in: people are configured
             */
            people: boolean;
            /** @description Null: nobody known */
            person: components["schemas"]["PersonOut"] | null;
            /**
             * Provider
             * @description What the provider is called that one can sign in at as well
             */
            provider: string | null;
        };
        /**
         * MethodFiguresOut
         * @description One method: the keys of a solve's report and what sets it apart.
         *
         *     A method that does not apply to the rig has `refusal` and no figures.
         */
        MethodFiguresOut: {
            blocking?: components["schemas"]["BlockingOut"] | null;
            /** Claims Limits */
            claims_limits: boolean;
            /**
             * Exact Percent
             * @description The share as tables show it: in hundredths, rounded down
             */
            exact_percent?: number | null;
            /** Exact Samples */
            exact_samples?: number | null;
            /**
             * Exact Share
             * @description 0..1, of the samples
             */
            exact_share?: number | null;
            /** Failures */
            failures?: components["schemas"]["FailureOut"][] | null;
            /** Feasible */
            feasible?: boolean | null;
            /**
             * How Sure
             * @description What a verdict of the planner rests on, in words
             */
            how_sure?: string | null;
            iterations?: components["schemas"]["IterationsOut"] | null;
            /**
             * Label
             * @description Unlike every other of the comparison
             */
            label: string;
            /** Limit Violation Counts */
            limit_violation_counts?: {
                [key: string]: {
                    [key: string]: number;
                };
            } | null;
            /** Limit Violation Samples */
            limit_violation_samples?: number | null;
            /** Limit Violations */
            limit_violations?: components["schemas"]["ViolationOut"][] | null;
            /** Limited By */
            limited_by?: {
                [key: string]: string | number;
            }[] | null;
            /** Limited Samples */
            limited_samples?: number | null;
            /** Max Error Deg */
            max_error_deg?: number | null;
            /** Max Matrix Error */
            max_matrix_error?: number | null;
            /** Method */
            method: string;
            /**
             * Options
             * @description The ones that were given
             * @default {}
             */
            options: {
                [key: string]: boolean | number | string;
            };
            peak?: components["schemas"]["PeaksOut"] | null;
            /** Refusal */
            refusal: string | null;
            /** Rig */
            rig?: string | null;
            /** Rms Error Deg */
            rms_error_deg?: number | null;
            /** Samples */
            samples?: number | null;
            /** Solve S */
            solve_s?: number | null;
            /** Source */
            source: string;
            step_us?: components["schemas"]["StepTimeOut"] | null;
            /** Total Variation Deg */
            total_variation_deg?: {
                [key: string]: number;
            } | null;
            /**
             * Why
             * @description What keeps it from every limit and attitude, first and then, in one sentence
             */
            why?: string | null;
        };
        /**
         * MethodIn
         * @description A method with options (GET /methods lists them), and what it is called in the table.
         */
        MethodIn: {
            /**
             * Label
             * @description Of its own; null: the name and the options given
             */
            label?: string | null;
            /** Method */
            method: string;
            /**
             * Options
             * @default {}
             */
            options: {
                [key: string]: boolean | number | string;
            };
        };
        /**
         * MethodOut
         * @description A method the server can solve with.
         */
        MethodOut: {
            /** Claims Limits */
            claims_limits: boolean;
            /** Name */
            name: string;
            /**
             * Options
             * @description Names and defaults
             */
            options: {
                [key: string]: boolean | number | string;
            };
            /** Source */
            source: string;
        };
        /** Move */
        Move: {
            args: components["schemas"]["MoveArgs"];
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            command: "move";
            lease?: components["schemas"]["LeaseToken"] | null;
        };
        /** MoveArgs */
        MoveArgs: {
            /** Target Deg */
            target_deg: [
                number,
                number,
                number,
                number
            ];
        };
        /**
         * NamedProfile
         * @description A shipped profile whose columns a file has.
         */
        NamedProfile: {
            /** About */
            about: string;
            /** Name */
            name: string;
        };
        /**
         * NearDuplicate
         * @description A sample whose stamp all but repeats the one before.
         */
        NearDuplicate: {
            /** Sample */
            sample: number;
            /** Time S */
            time_s: number;
        };
        /**
         * NeedleOut
         * @description A point that paths run exactly through, changing the side of cos d3, or pass by the half width at least.
         */
        NeedleOut: {
            /**
             * Base Deg
             * @description Half a turn on is another
             */
            base_deg: number;
            /** Half Width Deg */
            half_width_deg: number;
            /** Time S */
            time_s: number;
        };
        /**
         * NoArgs
         * @description A command without arguments.
         */
        NoArgs: Record<string, never>;
        /**
         * NoiseCost
         * @description Standard deviations of a frame's acceleration, over the flight.
         */
        NoiseCost: {
            /** Max */
            max: number;
            /** Median */
            median: number;
        };
        /**
         * NoisePlot
         * @description Noise over time: the largest divided difference of each stretch.
         */
        NoisePlot: {
            /** Time S */
            time_s: number[];
            /** X Deg */
            x_deg: number[];
            /** Y Deg */
            y_deg: number[];
            /** Z Deg */
            z_deg: number[];
        };
        /**
         * Notice
         * @description Something accepted that a person should look at.
         */
        Notice: {
            /** Code */
            code: string;
            /** Column */
            column?: string | null;
            /** Message */
            message: string;
            /**
             * Row
             * @description Line of a text, row of another file; the first is 1
             */
            row?: number | null;
            /** Value */
            value?: string | null;
        };
        /** Opened */
        Opened: {
            /** Method */
            method: string;
            /** Rig */
            rig: string;
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            type: "opened";
        };
        /**
         * OpenLive
         * @description First message of the client. With `lease` it loads the live source; with `key` somebody else has loaded it.
         *
         *     The key is what that load was answered (`live_key`). `convention` is of JSON samples: nue (yaw, pitch, roll) or ned
         *     (heading, pitch, bank).
         */
        OpenLive: {
            /**
             * Convention
             * @default nue
             * @enum {string}
             */
            convention: "nue" | "ned";
            /**
             * First Sample S
             * @description How long go_live waits for the source
             * @default 5
             */
            first_sample_s: number;
            /**
             * Key
             * @default null
             */
            key: string | null;
            /** @default null */
            lease: components["schemas"]["LeaseToken"] | null;
            /**
             * Method
             * @default exact
             */
            method: string;
            /**
             * Options
             * @default {}
             */
            options: {
                [key: string]: boolean | number | string;
            };
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            type: "open";
            /**
             * Udp From
             * @description Address and port, 127.0.0.1:7461, that the source sends from by UDP; null: it has the key
             * @default null
             */
            udp_from: string | null;
        };
        /**
         * OpenSolve
         * @description First message of the client.
         */
        OpenSolve: {
            /**
             * Method
             * @default exact
             */
            method: string;
            /**
             * Options
             * @default {}
             */
            options: {
                [key: string]: boolean | number | string;
            };
            /** Rig */
            rig: string;
            /**
             * Start Deg
             * @default null
             */
            start_deg: [
                number,
                number,
                number,
                number
            ] | null;
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            type: "open";
        };
        /**
         * OutlierOut
         * @description A sample off its neighbours.
         */
        OutlierOut: {
            /** Sample */
            sample: number;
            /** Sigmas */
            sigmas: number;
            /** Size Deg */
            size_deg: number;
            /** Time S */
            time_s: number;
        };
        /**
         * PasswordIn
         * @description One's own password, changed: every other session of the person ends.
         */
        PasswordIn: {
            /** Current */
            current: string;
            /** New */
            new: string;
            /**
             * Revoke Tokens
             * @description Also every token, but one that asks for it
             * @default false
             */
            revoke_tokens: boolean;
        };
        /**
         * Pause
         * @description Replay only.
         */
        Pause: {
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            type: "pause";
        };
        /**
         * PayloadOut
         * @description What the rig carries, for the scene: a box or a mesh file.
         */
        PayloadOut: {
            /** Mesh */
            mesh?: string | null;
            /** Size M */
            size_m?: [
                number,
                number,
                number
            ] | null;
        };
        /** PeakOut */
        PeakOut: {
            /** Acceleration Deg S2 */
            acceleration_deg_s2: number;
            /**
             * Jerk Deg S3
             * @description Of the samples' third differences
             */
            jerk_deg_s3?: number | null;
            /**
             * Jerk Percent
             * @description Of the frame's limit; null: it has none
             */
            jerk_percent?: number | null;
            /** Position Deg */
            position_deg: number;
            /** Rate Deg S */
            rate_deg_s: number;
        };
        /** PeaksOut */
        PeaksOut: {
            base?: components["schemas"]["PeakOut"] | null;
            inner: components["schemas"]["PeakOut"];
            middle: components["schemas"]["PeakOut"];
            outer: components["schemas"]["PeakOut"];
        };
        /**
         * PersonOut
         * @description Who is signed in, and by what.
         */
        PersonOut: {
            /** Name */
            name: string;
            /**
             * Role
             * @enum {string}
             */
            role: "viewer" | "operator" | "admin";
            /**
             * Until
             * @description When the session or token ends by itself
             */
            until: string | null;
            /**
             * Via
             * @enum {string}
             */
            via: "session" | "token";
        };
        /** Ping */
        Ping: {
            /** T */
            t: number;
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            type: "ping";
        };
        /**
         * PlaneOut
         * @description What a path can leave of the limits at most, over time (from the flight's begin) and base angle.
         *
         *     `margin` and `limits` are base64 of a byte a cell: first the side cos d3 >= 0, then the other; of each time after
         *     time, of each base angle after base angle, evenly from the first to the last of `base_deg`.
         */
        PlaneOut: {
            /** Base Deg */
            base_deg: [
                number,
                number
            ];
            /**
             * Limits
             * @description Lower half: the limit that leaves no more, 1 + 3 * frame + limit, of base, outer, middle, inner and position, rate, acceleration from 0; 0: none; upper: the one that holds it
             */
            limits: string;
            /**
             * Margin
             * @description Signed, per cent rounded down; negative: no path passes there inside the limits
             */
            margin: string;
            /**
             * Needles
             * @description The widest, by time
             */
            needles: components["schemas"]["NeedleOut"][];
            /** Needles Left Out */
            needles_left_out: number;
            path: components["schemas"]["PlanePathOut"];
            /** Rows */
            rows: number;
            tightest: components["schemas"]["TightestOut"];
            /** Time S */
            time_s: number[];
        };
        /**
         * PlanePathOut
         * @description The plan at the times of the map.
         */
        PlanePathOut: {
            /** Base Deg */
            base_deg: number[];
            /**
             * Limit
             * @description 1 + 3 * frame + limit, of base, outer, middle, inner and position, rate, acceleration from 0; 0: none
             */
            limit: number[];
            /**
             * Margin
             * @description Least share left about there of any limit, accelerations too [per cent]
             */
            margin: number[];
            /**
             * Side
             * @description 0 where cos d3 >= 0, else 1
             */
            side: number[];
        };
        /**
         * PlanIn
         * @description What to plan. Without `start_deg` the start pose is free; without `tolerance_deg` the flight is as it is.
         */
        PlanIn: {
            /**
             * Method
             * @default plan
             */
            method: string;
            /**
             * Options
             * @default {}
             */
            options: {
                [key: string]: boolean | number | string;
            };
            /** Rig */
            rig: string;
            /** Start Deg */
            start_deg?: [
                number,
                number,
                number,
                number
            ] | null;
            /** Tolerance Deg */
            tolerance_deg?: number | null;
            /** Trajectory */
            trajectory: string;
        };
        /**
         * PlanOut
         * @description A plan and its job. `flyable` plans can be loaded; the others say why not in `refusal`.
         */
        PlanOut: {
            /**
             * Created At
             * Format: date-time
             */
            created_at: string;
            /** Duration S */
            duration_s: number | null;
            error: components["schemas"]["JobErrorOut"] | null;
            /** Feasible */
            feasible: boolean | null;
            /** Finished At */
            finished_at: string | null;
            /** Flyable */
            flyable: boolean;
            /** Id */
            id: string;
            /** Lead In S */
            lead_in_s: number | null;
            /** Lead Out S */
            lead_out_s: number | null;
            margins: components["schemas"]["MarginsOut"] | null;
            /** Method */
            method: string;
            /** Notes */
            notes: string;
            /** Options */
            options: {
                [key: string]: boolean | number | string;
            };
            /** Plan Hash */
            plan_hash: string | null;
            progress: components["schemas"]["ProgressOut"];
            /** Rate Hz */
            rate_hz: number | null;
            /** Refusal */
            refusal: string | null;
            /** @description Null: the flight as it is */
            remedy: components["schemas"]["RemedyOut"] | null;
            report: components["schemas"]["ReportOut"] | null;
            /**
             * Resampling
             * @description How the flight was brought to the rig's rate
             */
            resampling: string | null;
            /** Rig */
            rig: string;
            /** Rig Hash */
            rig_hash: string;
            /** Samples */
            samples: number | null;
            /** Start Deg */
            start_deg: [
                number,
                number,
                number,
                number
            ] | null;
            /** Started At */
            started_at: string | null;
            status: components["schemas"]["JobStatus"];
            /** Tags */
            tags: string[];
            /** Tolerance Deg */
            tolerance_deg: number | null;
            /** Trajectory */
            trajectory: string;
            /** Trajectory Name */
            trajectory_name: string;
            /**
             * Verdict
             * @description What the verdict rests on, in words
             */
            verdict: string | null;
        };
        /**
         * PlanRef
         * @description The plan, or the live source, bound by load.
         */
        PlanRef: {
            /** Duration S */
            duration_s: number | null;
            /** Live */
            live: boolean;
            /** Name */
            name: string;
            /** Plan Hash */
            plan_hash: string;
            /** Plan Id */
            plan_id: string;
            /** Rig Hash */
            rig_hash: string;
        };
        /**
         * PlanSamples
         * @description A thinned plan for plots, lead-in and lead-out included; time zero is the flight's first sample.
         *
         *     Error and attitude are null in the leads. Peaks of every column are kept by the thinning.
         */
        PlanSamples: {
            /** Accelerations Deg S2 */
            accelerations_deg_s2: {
                [key: string]: number[];
            };
            /** Angles Deg */
            angles_deg: {
                [key: string]: number[];
            };
            /** Error Deg */
            error_deg: (number | null)[];
            /** Id */
            id: string;
            /** Jerks Deg S3 */
            jerks_deg_s3: {
                [key: string]: number[];
            };
            /** Lead In S */
            lead_in_s: number;
            /** Lead Out S */
            lead_out_s: number;
            /** Q */
            q: ([
                number,
                number,
                number,
                number
            ] | null)[];
            /** Rates Deg S */
            rates_deg_s: {
                [key: string]: number[];
            };
            /** Samples */
            samples: number;
            /** Time S */
            time_s: number[];
        };
        /**
         * Play
         * @description Replay only: on from here; from the beginning where it has come to the end.
         */
        Play: {
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            type: "play";
        };
        /** Pong */
        Pong: {
            /** Server Time */
            server_time: number;
            /** T */
            t: number;
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            type: "pong";
        };
        /**
         * Problem
         * @description Every error answer, as application/problem+json.
         */
        Problem: {
            /**
             * Allowed
             * @description Commands the state allows
             * @default null
             */
            allowed: string[] | null;
            /**
             * Command
             * @default null
             */
            command: string | null;
            /** Detail */
            detail: string;
            /**
             * Errors
             * @default []
             */
            errors: components["schemas"]["FieldProblem"][];
            /**
             * Instance
             * @default null
             */
            instance: string | null;
            /**
             * State
             * @description Session state, where a command was refused
             * @default null
             */
            state: string | null;
            /** Status */
            status: number;
            /** Title */
            title: string;
            /**
             * Type
             * @description urn:fullpose:problem:<code>; the code is stable, the texts are not
             */
            type: string;
        };
        /**
         * ProfileIn
         * @description A column map to be saved.
         */
        ProfileIn: {
            /**
             * About
             * @default
             */
            about: string;
            columns: components["schemas"]["ColumnMap"];
        };
        /**
         * ProfileOut
         * @description A named profile.
         */
        ProfileOut: {
            /** About */
            about: string;
            /**
             * Axes
             * @enum {string}
             */
            axes: "nue" | "ned" | "enu";
            /** Name */
            name: string;
            /**
             * Saved
             * @description By a person, on this server; others ship
             */
            saved: boolean;
        };
        /**
         * ProgressOut
         * @description How far a job is.
         */
        ProgressOut: {
            /** Done */
            done: number;
            /** Fraction */
            fraction: number;
            /** Phase */
            phase: string;
            /** Total */
            total: number;
        };
        /**
         * QuantumOut
         * @description What the attitude is rounded to.
         */
        QuantumOut: {
            /** Deg */
            deg: number;
            /**
             * Of
             * @enum {string}
             */
            of: "angles_deg" | "quaternion" | "counts";
            /**
             * Unit
             * @description In what is rounded: degrees, or a quaternion's component
             */
            unit: number;
        };
        /**
         * QuaternionMap
         * @description A unit quaternion.
         */
        QuaternionMap: {
            /** Columns */
            columns: [
                string,
                string,
                string,
                string
            ];
            /** @default body_to_reference */
            sense: components["schemas"]["Sense"];
        };
        /**
         * ReadFlight
         * @description The flight that a file makes; columns of equal length, thinned.
         */
        ReadFlight: {
            /**
             * Convention
             * @enum {string}
             */
            convention: "nue" | "ned" | "enu";
            /** Duration S */
            duration_s: number;
            /** Pitch Deg */
            pitch_deg: number[];
            /** Q */
            q: [
                number,
                number,
                number,
                number
            ][];
            /** Roll Deg */
            roll_deg: number[];
            /**
             * Samples
             * @description Of the whole flight
             */
            samples: number;
            /** Statement */
            statement: string;
            /** Time S */
            time_s: number[];
            /** Warnings */
            warnings: components["schemas"]["Notice"][];
            /** Yaw Deg */
            yaw_deg: number[];
        };
        /**
         * ReadingPreview
         * @description A file looked at before it is stored: what its columns are taken for, and the flight that this makes.
         */
        ReadingPreview: {
            columns: components["schemas"]["ColumnMap"] | null;
            flight: components["schemas"]["ReadFlight"] | null;
            /** Format */
            format: string;
            /**
             * Head
             * @description The first rows, as text; what cannot be seen is escaped
             */
            head: string[][];
            /** Names */
            names: string[];
            /**
             * Problem
             * @description Why it makes no flight as it is read
             */
            problem: string | null;
            /**
             * Profile
             * @description That was taken; null where none fits, empty where the columns were given
             */
            profile: string | null;
            /** Profiles */
            profiles: components["schemas"]["NamedProfile"][];
            /**
             * Remedy
             * @description The field by which it may be read all the same
             */
            remedy: ("bridge_gaps" | "drop_duplicates" | "profile" | "source") | null;
            /** Table */
            table: string;
            /** Tables */
            tables: string[];
            /**
             * Units
             * @description Of each column, as the file says it
             */
            units: (string | null)[];
        };
        /**
         * Record
         * @description The binary record: its size in bytes and its fields.
         */
        Record: {
            /** Fields */
            fields: components["schemas"]["RecordField"][];
            /** Size */
            size: number;
        };
        /**
         * RecorderOut
         * @description The recorder process of a rig.
         */
        RecorderOut: {
            /** Alive */
            alive: boolean;
            /** Bytes Written */
            bytes_written: number;
            /** Error */
            error: string;
            /** Free Bytes */
            free_bytes: number;
            /**
             * Lag
             * @description Samples between the loop and the recorder
             */
            lag: number;
            /**
             * Lost
             * @description Samples that never reached the record
             */
            lost: number;
            /**
             * Run
             * @description Id of the run being written, or empty
             */
            run: string;
        };
        /**
         * RecordField
         * @description One field of the binary record.
         */
        RecordField: {
            /** Count */
            count: number;
            /** Name */
            name: string;
            /** Offset */
            offset: number;
            /**
             * Type
             * @description NumPy type string, little-endian
             */
            type: string;
        };
        /**
         * RemedyChange
         * @description What was changed, by how much (`unit`: times, deg, deg/s or deg/s^2), that in words, and what it costs.
         */
        RemedyChange: {
            cost?: components["schemas"]["RemedyCost"] | null;
            /** Statement */
            statement: string;
            /** Unit */
            unit: string;
            /** Value */
            value: number;
            /**
             * What
             * @description attitude; time; the axis yaw, pitch or roll; frame and limit; or nothing
             */
            what: string;
        };
        /**
         * RemedyCost
         * @description What a remedy costs; null what it leaves alone.
         */
        RemedyCost: {
            /** Deviation Max Deg */
            deviation_max_deg?: number | null;
            /** Deviation Rms Deg */
            deviation_rms_deg?: number | null;
            /** Longer Percent */
            longer_percent?: number | null;
            /** Longer S */
            longer_s?: number | null;
            /**
             * Raised By
             * @description In the unit of the limit; of a range on each side
             */
            raised_by?: number | null;
            /** Turned Deg */
            turned_deg?: number | null;
        };
        /**
         * RemedyIn
         * @description What may be changed to make a flight fit; `relax` may be asked of one frame or one kind of limit alone.
         */
        RemedyIn: {
            /** Frame */
            frame?: ("base" | "outer" | "middle" | "inner") | null;
            /**
             * Kind
             * @enum {string}
             */
            kind: "tolerance" | "slow_down" | "heading_offset" | "mounting_offset" | "relax";
            /** Limit */
            limit?: ("position" | "rate" | "acceleration" | "jerk") | null;
        };
        /**
         * RemedyOut
         * @description The remedy that a plan is. What was changed is null until the search has ended.
         */
        RemedyOut: {
            /**
             * Alternatives
             * @description Other single limits that would do, the least raise first
             */
            alternatives: components["schemas"]["RemedyChange"][];
            change: components["schemas"]["RemedyChange"] | null;
            /** Frame */
            frame: ("base" | "outer" | "middle" | "inner") | null;
            /**
             * Kind
             * @enum {string}
             */
            kind: "tolerance" | "slow_down" | "heading_offset" | "mounting_offset" | "relax";
            /** Limit */
            limit: ("position" | "rate" | "acceleration" | "jerk") | null;
            /**
             * Of
             * @description The plan that it is a remedy of
             */
            of: string;
            /**
             * Sufficient
             * @description Whether the flight fits with it
             */
            sufficient: boolean | null;
        };
        /**
         * Replayed
         * @description Where a replay is: the answer to seek, speed, pause and play; with the topic session also when it ends.
         */
        Replayed: {
            /** Factor */
            factor: number;
            /** Playing */
            playing: boolean;
            /** Time S */
            time_s: number;
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            type: "replay";
        };
        /**
         * ReplayOf
         * @description The run that is replayed.
         */
        ReplayOf: {
            /** Duration S */
            duration_s: number;
            /** Run */
            run: string;
            /**
             * Scene
             * @description Where this client's scene of it is, while the WebSocket is open
             */
            scene: string;
            /**
             * Started
             * @description Seconds since 1970, of the first sample
             */
            started: number | null;
        };
        /**
         * ReportOut
         * @description The report of `fullpose solve --report`, key by key; keys may be added, not renamed.
         */
        ReportOut: {
            blocking: components["schemas"]["BlockingOut"] | null;
            /** @description That the tolerance was used for */
            deviation_deg?: components["schemas"]["DeviationOut"] | null;
            /**
             * Exact Percent
             * @description In hundredths, rounded down
             */
            exact_percent?: number | null;
            /**
             * Exact Samples
             * @description Within 1e-9 deg of the attitude
             */
            exact_samples?: number | null;
            /**
             * Feasible
             * @description Inside every limit, no sample given up for one; see exact_samples
             */
            feasible: boolean;
            iterations: components["schemas"]["IterationsOut"];
            /** @description Of method plan */
            leads?: components["schemas"]["LeadsOut"] | null;
            /**
             * Limit Violation Samples
             * @description All of them; the list is cut at a thousand runs
             */
            limit_violation_samples: number;
            /** Limit Violations */
            limit_violations: components["schemas"]["ViolationOut"][];
            /**
             * Limited By
             * @description frame, limit, samples
             */
            limited_by: {
                [key: string]: string | number;
            }[];
            /** Limited Samples */
            limited_samples: number;
            /**
             * Max Error Deg
             * @description To the flight as it was given
             */
            max_error_deg: number;
            /** Max Matrix Error */
            max_matrix_error: number;
            /** Method */
            method: string;
            peak: components["schemas"]["PeaksOut"];
            /** Rig */
            rig: string;
            /** Samples */
            samples: number;
            /**
             * Smoothing
             * @description What was taken away, in words
             */
            smoothing?: string | null;
            /** Solve S */
            solve_s: number | null;
            step_us: components["schemas"]["StepTimeOut"] | null;
            /**
             * Suggested Tolerance Deg
             * @description Null where none is needed
             */
            suggested_tolerance_deg?: number | null;
            /**
             * Tolerance Deg
             * @description That the flight was planned within
             */
            tolerance_deg?: number | null;
            /**
             * Tolerance Floor Deg
             * @description Below it no tolerance helps
             */
            tolerance_floor_deg?: number | null;
            /** @description Of method plan */
            verdict?: components["schemas"]["VerdictOut"] | null;
            /**
             * Warnings
             * @default []
             */
            warnings: components["schemas"]["Notice"][];
            /**
             * Within Tolerance
             * @description Whether every sample is
             */
            within_tolerance?: boolean | null;
        };
        /** Reset */
        Reset: {
            /** @default {} */
            args: components["schemas"]["NoArgs"];
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            command: "reset";
            lease?: components["schemas"]["LeaseToken"] | null;
        };
        /** Resume */
        Resume: {
            /** @default {} */
            args: components["schemas"]["NoArgs"];
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            command: "resume";
            lease?: components["schemas"]["LeaseToken"] | null;
        };
        /**
         * RigCost
         * @description What the noise costs a rig's frames.
         */
        RigCost: {
            /** Frames */
            frames: {
                [key: string]: components["schemas"]["FrameCost"];
            };
            /** Name */
            name: string;
        };
        /**
         * RigHealth
         * @description How the rig process does; lateness over its whole life, by percentile.
         */
        RigHealth: {
            /** Busy Us */
            busy_us: number;
            /** Deadline Misses */
            deadline_misses: number;
            drive?: components["schemas"]["DriveTimes"] | null;
            /** Heartbeat Age S */
            heartbeat_age_s: number | null;
            /** Lateness Us */
            lateness_us: {
                [key: string]: number;
            };
            live?: components["schemas"]["LiveOut"] | null;
            /** Rate Hz */
            rate_hz: number;
            /**
             * Realtime
             * @description Scheduling in words: real-time, or what is missing
             */
            realtime: string;
            recorder: components["schemas"]["RecorderOut"] | null;
            /** Rig Alive */
            rig_alive: boolean;
            /** Rig Pid */
            rig_pid: number | null;
            /** Ticks */
            ticks: number;
        };
        /**
         * RigOut
         * @description A rig the server knows, and the state of its session.
         */
        RigOut: {
            /** Builtin */
            builtin: boolean;
            frames: components["schemas"]["FramesOut"];
            /**
             * Geometry
             * @enum {string}
             */
            geometry: "vertical-4" | "horizontal-4" | "vertical-3" | "horizontal-3";
            /** Name */
            name: string;
            payload: components["schemas"]["PayloadOut"];
            /** Redundant */
            redundant: boolean;
            /** Rig Hash */
            rig_hash: string;
            /**
             * Scene
             * @description Where the rig's 3D scene is
             */
            scene: string;
            /**
             * State
             * @description Session state; disconnected where no rig process runs
             */
            state: string;
        };
        /**
         * RigStopped
         * @description The rig brakes; where `done.unknown` says so, the order was given and that is all that is known.
         */
        RigStopped: {
            done: components["schemas"]["CommandOut"];
            /** Id */
            id: number;
            /** Rig */
            rig: string;
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            type: "stopped";
        };
        /**
         * RunEnd
         * @description The words.
         * @enum {string}
         */
        RunEnd: "completed" | "stopped" | "source_lost" | "owner_silent" | "server_silent" | "estop" | "fault" | "link_lost" | "process_lost";
        /**
         * RunnerStatus
         * @description What a runner does.
         * @enum {string}
         */
        RunnerStatus: "starting" | "restarting" | "idle" | "busy" | "stopped";
        /**
         * RunOut
         * @description A recorded run; errors are those of the flight itself, running or held, leads left out.
         */
        RunOut: {
            /** Bytes */
            bytes: number;
            /**
             * Complete
             * @description False while it is being written, or where it was cut off or is damaged
             */
            complete: boolean;
            /** Duration S */
            duration_s: number | null;
            /** @description How it ended; null: not known (a record that was cut off, or of an earlier version), or not yet */
            end: components["schemas"]["RunEnd"] | null;
            /**
             * End Code
             * @description Of the alarm that ended it, where one did
             */
            end_code: string | null;
            /** Ended At */
            ended_at: string | null;
            /**
             * Error
             * @description Why the record cannot be read: then nothing but its name is known
             */
            error: string | null;
            /** Id */
            id: string;
            /**
             * Incident
             * @description Null: a run. Else no flight: what was kept around a fault while no run was recorded, and the code of its alarm
             */
            incident: string | null;
            /**
             * Lost Samples
             * @description Sequence numbers that are missing, from its beginning to its end
             */
            lost_samples: number | null;
            /** Max Lateness Us */
            max_lateness_us: number | null;
            /** Max Solve Error Deg */
            max_solve_error_deg: number | null;
            /** Max Tracking Error Deg */
            max_tracking_error_deg: number | null;
            /** Notes */
            notes: string;
            /**
             * Pinned
             * @description It stays, whatever its age, and cannot be deleted
             */
            pinned: boolean;
            /** Plan Hash */
            plan_hash: string | null;
            /** Plan Id */
            plan_id: string | null;
            /** Rig */
            rig: string;
            /**
             * Samples
             * @description Null, like all that follows from them, while the run is being written
             */
            samples: number | null;
            /** Started At */
            started_at: string | null;
            /** Tags */
            tags: string[];
            /** Who */
            who: string;
        };
        /**
         * SampleRefused
         * @description Why a sample was not used: its `value` is beyond the `limit`, both in `unit`.
         */
        SampleRefused: {
            /**
             * Code
             * @constant
             */
            code: "implausible_rate";
            /** Limit */
            limit: number;
            /**
             * Unit
             * @constant
             */
            unit: "deg/s";
            /**
             * Value
             * @description The body rate, as the sample says or as it takes; null: no number
             */
            value: number | null;
        };
        /**
         * ScenePoseIn
         * @description An instant of a plan.
         */
        ScenePoseIn: {
            /** Plan Id */
            plan_id: string;
            /**
             * Time S
             * @description Zero is the flight's first sample; negative in the lead-in
             */
            time_s: number;
        };
        /**
         * ScenePoseOut
         * @description What is shown: the plan's sample nearest to the time asked for.
         */
        ScenePoseOut: {
            /** Angles Deg */
            angles_deg: [
                number,
                number,
                number,
                number
            ];
            /** Error Deg */
            error_deg: number | null;
            /** Plan Id */
            plan_id: string;
            /**
             * Q
             * @description The flight's attitude (w, x, y, z); null in the leads
             */
            q: [
                number,
                number,
                number,
                number
            ] | null;
            /** Time S */
            time_s: number;
        };
        /**
         * Seek
         * @description Replay only: to that time, playing or not. The newest sample there is sent at once.
         */
        Seek: {
            /**
             * Time S
             * @description After the run's first sample
             */
            time_s: number;
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            type: "seek";
        };
        /**
         * Sense
         * @description What a quaternion takes from where to where: v_reference = q v_body q* is `body_to_reference`.
         * @enum {string}
         */
        Sense: "body_to_reference" | "reference_to_body";
        /** ServerLimits */
        ServerLimits: {
            /** Max Solve Samples */
            max_solve_samples: number;
            /** Max Upload Bytes */
            max_upload_bytes: number;
        };
        /** SessionChanged */
        SessionChanged: {
            /** Revision */
            revision: number;
            /** Server Time */
            server_time: number;
            session: components["schemas"]["SessionOut"];
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            type: "session";
        };
        /**
         * SessionOut
         * @description All an operator must know: state, what is allowed, who holds the lease, the plan, the alarms, health, pose.
         */
        SessionOut: {
            /**
             * Alarms
             * @description Those that stand
             */
            alarms: components["schemas"]["AlarmOut"][];
            /** Allowed */
            allowed: string[];
            /** Drive */
            drive: string | null;
            health: components["schemas"]["RigHealth"];
            /** History */
            history: components["schemas"]["AlarmOut"][];
            lease: components["schemas"]["LeaseOut"];
            plan: components["schemas"]["PlanRef"] | null;
            /** Pose Deg */
            pose_deg: [
                number,
                number,
                number,
                number
            ] | null;
            /** Revision */
            revision: number;
            /** Rig */
            rig: string;
            /** Run Id */
            run_id: string | null;
            /**
             * Shelves
             * @description Warnings that are kept out of sight for a time
             * @default []
             */
            shelves: components["schemas"]["ShelfOut"][];
            state: components["schemas"]["State"];
        };
        /**
         * Severity
         * @description How bad: a warning leaves the motion alone, a fault brakes, an emergency brakes and disables.
         * @enum {string}
         */
        Severity: "warning" | "fault" | "emergency";
        /**
         * ShelfArgs
         * @description The warning that is kept out of sight, for a time that ends. Nothing that brakes a rig can be shelved.
         */
        ShelfArgs: {
            code: components["schemas"]["WarningCode"];
            /**
             * Frame
             * @description null: of every frame
             */
            frame?: ("base" | "outer" | "middle" | "inner") | null;
            /**
             * Minutes
             * @description How long; then it stands again when it returns
             */
            minutes: number;
            /**
             * Reason
             * @default
             */
            reason: string;
        };
        /**
         * ShelfOut
         * @description A warning that is kept out of sight: it is in the history, and does not stand.
         */
        ShelfOut: {
            /** By */
            by: string;
            /** Code */
            code: string;
            /** Frame */
            frame: ("base" | "outer" | "middle" | "inner") | null;
            /** Reason */
            reason: string;
            /**
             * Since S
             * @description Seconds since 1970
             */
            since_s: number;
            /**
             * Until S
             * @description Seconds since 1970; then it stands again when it returns
             */
            until_s: number;
        };
        /** Shelve */
        Shelve: {
            args: components["schemas"]["ShelfArgs"];
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            command: "shelve";
            lease?: components["schemas"]["LeaseToken"] | null;
        };
        /**
         * Solved
         * @description Answer to one `samples` message, row by row; `limited.sample` counts within the message.
         */
        Solved: {
            /** Angles Deg */
            angles_deg: [
                number,
                number,
                number,
                number
            ][];
            /** Error Deg */
            error_deg: number[];
            /** Limited */
            limited: components["schemas"]["Limited"][];
            /** Time S */
            time_s: number[];
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            type: "solved";
        };
        /** SolveIn */
        SolveIn: {
            /**
             * Euler Deg
             * @default null
             */
            euler_deg: [
                number,
                number,
                number
            ][] | null;
            /**
             * Method
             * @default exact
             */
            method: string;
            /**
             * Options
             * @default {}
             */
            options: {
                [key: string]: boolean | number | string;
            };
            /**
             * Q
             * @default null
             */
            q: [
                number,
                number,
                number,
                number
            ][] | null;
            /** Rig */
            rig: string;
            /**
             * Start Deg
             * @default null
             */
            start_deg: [
                number,
                number,
                number,
                number
            ] | null;
            /** Time S */
            time_s: number[];
        };
        SolveMessageIn: components["schemas"]["OpenSolve"] | components["schemas"]["SolveSamples"];
        SolveMessageOut: components["schemas"]["Opened"] | components["schemas"]["Solved"] | components["schemas"]["SolveProblem"];
        /** SolveOut */
        SolveOut: {
            /** Angles Deg */
            angles_deg: [
                number,
                number,
                number,
                number
            ][];
            /** Error Deg */
            error_deg: number[];
            /** Limited */
            limited: components["schemas"]["Limited"][];
            report: components["schemas"]["ReportOut"];
            /** Time S */
            time_s: number[];
        };
        /** SolveProblem */
        SolveProblem: {
            problem: components["schemas"]["Problem"];
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            type: "problem";
        };
        /**
         * SolveSamples
         * @description The next attitudes of the flight; time goes on from message to message.
         */
        SolveSamples: {
            /**
             * Euler Deg
             * @default null
             */
            euler_deg: [
                number,
                number,
                number
            ][] | null;
            /**
             * Q
             * @default null
             */
            q: [
                number,
                number,
                number,
                number
            ][] | null;
            /** Time S */
            time_s: number[];
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            type: "samples";
        };
        /**
         * Speed
         * @description Replay only.
         */
        Speed: {
            /**
             * Factor
             * @description 1: as fast as it was
             */
            factor: number;
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            type: "speed";
        };
        /**
         * StampsOut
         * @description How regular the stamps are.
         */
        StampsOut: {
            /** Jitter Max S */
            jitter_max_s: number;
            /** Jitter Rms S */
            jitter_rms_s: number;
            /** Quantum S */
            quantum_s: number;
            /**
             * Regular Rate Hz
             * @description Of the regular clock that explains the jitter
             */
            regular_rate_hz: number | null;
        };
        /** Start */
        Start: {
            /** @default {} */
            args: components["schemas"]["NoArgs"];
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            command: "start";
            lease?: components["schemas"]["LeaseToken"] | null;
        };
        /**
         * State
         * @description Where a rig's session is. The order is the code in telemetry (`State.code`).
         * @enum {string}
         */
        State: "disconnected" | "idle" | "ready" | "armed" | "positioning" | "running" | "held" | "stopping" | "live" | "estopped" | "faulted";
        /**
         * StepsOut
         * @description Steps between samples [s].
         */
        StepsOut: {
            /** Max */
            max: number;
            /** Median */
            median: number;
            /** Min */
            min: number;
        };
        /**
         * StepsPlot
         * @description How many steps are between each edge and the next.
         */
        StepsPlot: {
            /** Count */
            count: number[];
            /** Edge S */
            edge_s: number[];
        };
        /** StepTimeOut */
        StepTimeOut: {
            /** Median */
            median: number;
            /** P99 */
            p99: number;
        };
        /** Stop */
        Stop: {
            /** @default {} */
            args: components["schemas"]["NoArgs"];
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            command: "stop";
            lease?: components["schemas"]["LeaseToken"] | null;
        };
        StopMessageIn: components["schemas"]["StopRig"] | components["schemas"]["Ping"];
        StopMessageOut: components["schemas"]["RigStopped"] | components["schemas"]["Pong"] | components["schemas"]["StopRefused"];
        /**
         * StopNow
         * @description Live only: the priority channel of stop and E-stop, as POST /rigs/{rig}/stop and /estop. No lease; at once.
         */
        StopNow: {
            /**
             * Client
             * @description As the header X-Fullpose-Client, which it replaces
             * @default null
             */
            client: string | null;
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            type: "stop" | "estop";
        };
        /**
         * Stopped
         * @description The answer to stop and estop: what the session was and is.
         */
        Stopped: {
            /** Command */
            command: string;
            /** Revision */
            revision: number;
            state_after: components["schemas"]["State"];
            state_before: components["schemas"]["State"];
            /**
             * Stop Category
             * @description Of stop and estop, IEC 60204-1: 1, stopped under control, then power off; 2, power stays on. No safety function
             * @default null
             */
            stop_category: (1 | 2) | null;
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            type: "stopped";
            /**
             * Unknown
             * @description Of stop and estop, with 202: the order was given, and this is not known of what came of it
             * @default null
             */
            unknown: string | null;
        };
        /**
         * StopRefused
         * @description The message was none, or the session's state knows no such command.
         */
        StopRefused: {
            /**
             * Id
             * @default null
             */
            id: number | null;
            problem: components["schemas"]["Problem"];
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            type: "problem";
        };
        /**
         * StopRig
         * @description Stop or E-stop, now. Needs no lease and is never refused for a name.
         */
        StopRig: {
            /**
             * Client
             * @description Who stops, as the header X-Fullpose-Client
             * @default null
             */
            client: string | null;
            /**
             * Id
             * @description Told again in the answer
             * @default 0
             */
            id: number;
            /** Rig */
            rig: string;
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            type: "stop" | "estop";
        };
        StreamMessageIn: components["schemas"]["Subscribe"] | components["schemas"]["Ping"] | components["schemas"]["StopNow"] | components["schemas"]["Seek"] | components["schemas"]["Speed"] | components["schemas"]["Pause"] | components["schemas"]["Play"];
        StreamMessageOut: components["schemas"]["Hello"] | components["schemas"]["Telemetry"] | components["schemas"]["SessionChanged"] | components["schemas"]["Replayed"] | components["schemas"]["Pong"] | components["schemas"]["Stopped"] | components["schemas"]["StreamProblem"];
        /**
         * StreamProblem
         * @description A message of the client that was not understood; the stream goes on.
         */
        StreamProblem: {
            problem: components["schemas"]["Problem"];
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            type: "problem";
        };
        /**
         * Subscribe
         * @description What the client wants; sent again, it replaces the earlier one.
         */
        Subscribe: {
            /**
             * Encoding
             * @default json
             * @enum {string}
             */
            encoding: "json" | "binary";
            /**
             * Every Sample
             * @description All samples since the last frame, else only the newest
             * @default false
             */
            every_sample: boolean;
            /**
             * Rate Hz
             * @description Frames a second, not samples
             * @default 30
             */
            rate_hz: number;
            /**
             * Since Seq
             * @description Resume after this sample; null: from now on
             * @default null
             */
            since_seq: number | null;
            /**
             * Topics
             * @default [
             *       "telemetry",
             *       "session"
             *     ]
             */
            topics: ("telemetry" | "session")[];
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            type: "subscribe";
        };
        /**
         * Telemetry
         * @description Samples as columns. `seq` is the newest sample's; `dropped` counts what this client has missed so far.
         */
        Telemetry: {
            /** Demand */
            demand: (number | null)[][];
            /** Demand Acceleration */
            demand_acceleration: (number | null)[][];
            /** Demand Rate */
            demand_rate: (number | null)[][];
            /** Dropped */
            dropped: number;
            /** Flags */
            flags: number[];
            /** Following Error Deg */
            following_error_deg: (number | null)[][];
            /** Lateness Us */
            lateness_us: (number | null)[];
            /** Margin */
            margin: (number | null)[];
            /** Measured */
            measured: (number | null)[][];
            /** Measured Rate */
            measured_rate: (number | null)[][];
            /** Path Scale */
            path_scale: (number | null)[];
            /** Path Time S */
            path_time_s: (number | null)[];
            /** Read Us */
            read_us: (number | null)[];
            /** Revision */
            revision: number[];
            /** Sample Seq */
            sample_seq: number[];
            /** Seq */
            seq: number;
            /** Server Time */
            server_time: number;
            /** Solve Error Deg */
            solve_error_deg: (number | null)[];
            /** State */
            state: number[];
            /** Target */
            target: (number | null)[][];
            /** Tick */
            tick: number[];
            /** Time Ns */
            time_ns: number[];
            /** Tracking Error Deg */
            tracking_error_deg: (number | null)[];
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            type: "telemetry";
            /** Wall Ns */
            wall_ns: number[];
            /** Write Us */
            write_us: (number | null)[];
        };
        /**
         * TightestOut
         * @description Where the plan leaves least of a limit.
         */
        TightestOut: {
            /** Frame */
            frame: ("base" | "outer" | "middle" | "inner") | null;
            /** Limit */
            limit: ("position" | "rate" | "acceleration" | "jerk") | null;
            /**
             * Margin
             * @description Per cent, rounded down; negative beyond the limit
             */
            margin: number;
            /** Sentence */
            sentence: string;
            /** Time S */
            time_s: number;
        };
        /**
         * TimeMap
         * @description The column of the stamps.
         */
        TimeMap: {
            /** Column */
            column: string;
            /** @default file */
            epoch: components["schemas"]["Epoch"];
            /** @default s */
            unit: components["schemas"]["TimeUnit"];
        };
        /**
         * TimeUnit
         * @description What a stamp counts.
         * @enum {string}
         */
        TimeUnit: "s" | "ms" | "0.1ms" | "us" | "ns" | "min" | "h";
        /**
         * TokenGiven
         * @description A new token. `secret` is told here once, and nowhere else.
         */
        TokenGiven: {
            /**
             * Created
             * Format: date-time
             */
            created: string;
            /** Id */
            id: string;
            /** Label */
            label: string;
            /**
             * Role
             * @description Null: what the person is
             */
            role: ("viewer" | "operator" | "admin") | null;
            /** Secret */
            secret: string;
            /** Until */
            until: string | null;
            /** User */
            user: string;
        };
        /** TokenIn */
        TokenIn: {
            /**
             * Days
             * @description Null: until revoked
             */
            days?: number | null;
            /**
             * Label
             * @description What it is for
             */
            label: string;
            /**
             * Role
             * @description Less than the person's; null: what the person is
             */
            role?: ("viewer" | "operator" | "admin") | null;
        };
        /** TokenOut */
        TokenOut: {
            /**
             * Created
             * Format: date-time
             */
            created: string;
            /** Id */
            id: string;
            /** Label */
            label: string;
            /**
             * Role
             * @description Null: what the person is
             */
            role: ("viewer" | "operator" | "admin") | null;
            /** Until */
            until: string | null;
            /** User */
            user: string;
        };
        /**
         * ToleranceEffect
         * @description What a tolerance does to a flight before a rig is asked; columns of equal length for a plot.
         */
        ToleranceEffect: {
            /**
             * Cut Off Hz
             * @description What is slower is the flight; null: nothing was taken away
             */
            cut_off_hz: number | null;
            /** Deviation At Deg */
            deviation_at_deg: number[];
            deviation_deg: components["schemas"]["DeviationOut"];
            flown: components["schemas"]["BodyPeaks"];
            /**
             * Needed
             * @description Whether the recording makes a good part of the peak acceleration
             */
            needed: boolean;
            recorded: components["schemas"]["BodyPeaks"];
            /** Samples */
            samples: number;
            /**
             * Smoothing
             * @description What was taken away, in words
             */
            smoothing: string;
            /**
             * Suggested Tolerance Deg
             * @description Null where the recording added nothing
             */
            suggested_tolerance_deg: number | null;
            /** Time S */
            time_s: number[];
            /**
             * Tolerance Deg
             * @description That was asked for, or that is suggested
             */
            tolerance_deg: number | null;
            /**
             * Tolerance Floor Deg
             * @description Below it no tolerance helps
             */
            tolerance_floor_deg: number | null;
            /** Within Tolerance */
            within_tolerance: boolean;
        };
        /**
         * TrajectoryIn
         * @description A flight as JSON columns: `time_s` and one attitude, Euler angles or `q` (w, x, y, z).
         */
        TrajectoryIn: {
            /**
             * Bank Deg
             * @default null
             */
            bank_deg: number[] | null;
            /**
             * Bridge Gaps
             * @description Fly through gaps by interpolation
             * @default false
             */
            bridge_gaps: boolean;
            /**
             * Convention
             * @default nue
             * @enum {string}
             */
            convention: "nue" | "ned" | "enu";
            /**
             * Heading Deg
             * @default null
             */
            heading_deg: number[] | null;
            /** Name */
            name: string;
            /**
             * Pitch Deg
             * @default null
             */
            pitch_deg: number[] | null;
            /**
             * Q
             * @default null
             */
            q: [
                number,
                number,
                number,
                number
            ][] | null;
            /**
             * Roll Deg
             * @default null
             */
            roll_deg: number[] | null;
            /** Time S */
            time_s: number[];
            /**
             * Yaw Deg
             * @default null
             */
            yaw_deg: number[] | null;
        };
        /**
         * TrajectoryOut
         * @description A stored flight. Its address is the SHA-256 of the attitude samples, whatever file they came in.
         */
        TrajectoryOut: {
            /**
             * Convention
             * @enum {string}
             */
            convention: "nue" | "ned" | "enu";
            /**
             * Created At
             * Format: date-time
             */
            created_at: string;
            /** Duration S */
            duration_s: number;
            /** @description What was taken of the file; null of flights stored before it was kept */
            input: components["schemas"]["InputOut"] | null;
            /** Name */
            name: string;
            /** Notes */
            notes: string;
            /** Peak Body Rate Deg S */
            peak_body_rate_deg_s: number | null;
            /**
             * Rate Hz
             * @description From the median step; null for one sample
             */
            rate_hz: number | null;
            /** Samples */
            samples: number;
            /** Sha256 */
            sha256: string;
            /** Source Bytes */
            source_bytes: number;
            /**
             * Source Format
             * @description csv, parquet, json, or another format that is read
             */
            source_format: string;
            /**
             * Source Sha256
             * @description SHA-256 of the uploaded bytes
             */
            source_sha256: string;
            /** Start S */
            start_s: number;
            /** Tags */
            tags: string[];
            /** Uniform */
            uniform: boolean;
            /** Warnings */
            warnings: components["schemas"]["Notice"][];
        };
        /**
         * TrajectoryPreview
         * @description A thinned flight for plots: columns of equal length.
         */
        TrajectoryPreview: {
            /** Pitch Deg */
            pitch_deg: number[];
            /** Q */
            q: [
                number,
                number,
                number,
                number
            ][];
            /** Roll Deg */
            roll_deg: number[];
            /**
             * Samples
             * @description Of the whole flight
             */
            samples: number;
            /** Sha256 */
            sha256: string;
            /** Time S */
            time_s: number[];
            /** Yaw Deg */
            yaw_deg: number[];
        };
        /** Unload */
        Unload: {
            /** @default {} */
            args: components["schemas"]["NoArgs"];
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            command: "unload";
            lease?: components["schemas"]["LeaseToken"] | null;
        };
        /** Unshelve */
        Unshelve: {
            args: components["schemas"]["UnshelveArgs"];
            /**
             * @description discriminator enum property added by openapi-typescript
             * @enum {string}
             */
            command: "unshelve";
            lease?: components["schemas"]["LeaseToken"] | null;
        };
        /**
         * UnshelveArgs
         * @description Which shelf is taken away.
         */
        UnshelveArgs: {
            /** Code */
            code: string;
            /** Frame */
            frame?: ("base" | "outer" | "middle" | "inner") | null;
        };
        /**
         * UserChange
         * @description What is left out stays.
         */
        UserChange: {
            /** Disabled */
            disabled?: boolean | null;
            /**
             * Password
             * @description With another one their sessions end, but one that asks for it
             */
            password?: string | null;
            /**
             * Revoke Tokens
             * @description Every token of theirs, but one that asks for it
             */
            revoke_tokens?: boolean | null;
            /** Role */
            role?: ("viewer" | "operator" | "admin") | null;
        };
        /** UserIn */
        UserIn: {
            /** Name */
            name: string;
            /**
             * Password
             * @description Without: they sign in at the provider, or by token
             */
            password?: string | null;
            /**
             * Role
             * @enum {string}
             */
            role: "viewer" | "operator" | "admin";
        };
        /** UserOut */
        UserOut: {
            /**
             * Created
             * Format: date-time
             */
            created: string;
            /**
             * Disabled
             * @description Nothing of theirs is let in; all of it is again once they are enabled
             */
            disabled: boolean;
            /** Name */
            name: string;
            /**
             * Password
             * @description Whether they have one here
             */
            password: boolean;
            /**
             * Role
             * @enum {string}
             */
            role: "viewer" | "operator" | "admin";
        };
        /**
         * VerdictOut
         * @description What the verdict of method plan rests on.
         */
        VerdictOut: {
            /** @description How sure the verdict is */
            certainty?: components["schemas"]["Certainty"] | null;
            /** @description Where the search for an exact path came to its end */
            closed?: components["schemas"]["BlockingOut"] | null;
            /** @description Which frame cannot follow from there */
            consequence?: components["schemas"]["Consequence"] | null;
            /**
             * Decided By
             * @description checked; tolerance; or the limit that closes the way, start_rate, or three-axis
             */
            decided_by: string;
            /** @description The limit that a frame reaches first, and when */
            first?: components["schemas"]["LimitMetOut"] | null;
            /**
             * Grid Deg
             * @description Of the search; null where there was none
             */
            grid_deg: number | null;
            /**
             * How Sure
             * @description What that rests on, in words
             */
            how_sure?: string | null;
            /**
             * Least Tolerance Deg
             * @description The smallest attitude tolerance found for which the flight is inside every limit; 0: exact; null: not looked for
             */
            least_tolerance_deg?: number | null;
            /** Max Matrix Error Between Samples */
            max_matrix_error_between_samples: number | null;
            /** Statement */
            statement: string;
            /** @description What the attitude would need from there; of the same frame, bound is where it is then */
            then?: components["schemas"]["LimitMetOut"] | null;
            /**
             * What Happens
             * @description Why it is not flown exactly: what happens first and what then; null: it is, or unknown
             */
            what_happens?: string | null;
        };
        /**
         * VersionOut
         * @description What runs here.
         */
        VersionOut: {
            /**
             * Api
             * @description Where the API is
             */
            api: string;
            /**
             * Database Revision
             * @description A database of a newer revision is not opened
             */
            database_revision: string;
            /** Python */
            python: string;
            /** Version */
            version: string;
        };
        /**
         * ViolationOut
         * @description A run of samples beyond a limit, at its worst one.
         */
        ViolationOut: {
            /**
             * Frame
             * @enum {string}
             */
            frame: "base" | "outer" | "middle" | "inner";
            /**
             * Limit
             * @enum {string}
             */
            limit: "position" | "rate" | "acceleration" | "jerk";
            /**
             * Samples
             * @description Length of the run
             */
            samples: number;
            /** Time S */
            time_s: number;
            /**
             * Value
             * @description deg, deg/s, deg/s^2 or deg/s^3, by the limit
             */
            value: number;
        };
        /**
         * WarningCode
         * @description All of them; some are of a fault too, where a tolerance has a second level.
         * @enum {string}
         */
        WarningCode: "following_error" | "attitude_error" | "lateness" | "missed_deadlines" | "outside_range" | "stale_write" | "recorder_lost" | "record_error" | "disk_low" | "owner_silent" | "server_silent" | "live_source_lost" | "live_source_stale" | "live_bad" | "live_dropped" | "live_clock_steps" | "live_second_source" | "live_unproven" | "live_implausible_rate" | "preview_late";
    };
    responses: never;
    parameters: never;
    requestBodies: never;
    headers: never;
    pathItems: never;
}
export type $defs = Record<string, never>;
export interface operations {
    list_alarms_api_v1_alarms_get: {
        parameters: {
            query?: {
                /** @description Of the link to the next page */
                before?: string | null;
                code?: string | null;
                /** @description First raised then or later */
                from?: string | null;
                /** @description Rows of the page; 100 where not given */
                limit?: number | null;
                rig?: string | null;
                severity?: components["schemas"]["Severity"] | null;
                /** @description Those that stand, or those that do not */
                standing?: boolean | null;
                /** @description First raised before */
                to?: string | null;
            };
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The next page, `<path>; rel="next"`, where there is one */
                    Link?: string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["AlarmRecordOut"][];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    alive_api_v1_alive_get: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["AliveOut"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    list_audit_api_v1_audit_get: {
        parameters: {
            query?: {
                /** @description Id to go on from, backward */
                before?: number | null;
                limit?: number;
                rig?: string | null;
            };
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The next page, `<path>; rel="next"`, where there is one */
                    Link?: string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["AuditOut"][];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    list_comparisons_api_v1_compare_get: {
        parameters: {
            query?: {
                /** @description Of the link to the next page */
                before?: string | null;
                /** @description Rows of the page; 100 where not given */
                limit?: number | null;
            };
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The next page, `<path>; rel="next"`, where there is one */
                    Link?: string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["ComparisonOut"][];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    add_comparison_api_v1_compare_post: {
        parameters: {
            query?: never;
            header?: {
                /** @description Who commands, while no users are configured: a name for the lease and the audit */
                "x-fullpose-client"?: string | null;
            };
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["CompareIn"];
            };
        };
        responses: {
            /** @description Successful Response */
            202: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["ComparisonOut"];
                };
            };
            /** @description The body is not what its type says */
            400: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The rest of the request did not come */
            408: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Larger than a bound of this server */
            413: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Too many at once: try again later */
            429: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No room on the disk */
            507: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    get_comparison_api_v1_compare__comparison__get: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                comparison: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["ComparisonOut"];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    remove_comparison_api_v1_compare__comparison__delete: {
        parameters: {
            query?: never;
            header?: {
                /** @description Who commands, while no users are configured: a name for the lease and the audit */
                "x-fullpose-client"?: string | null;
            };
            path: {
                comparison: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            204: {
                headers: {
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No room on the disk */
            507: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    comparison_page_api_v1_compare__comparison__page_get: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                comparison: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "text/html": unknown;
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The comparison is not done */
            409: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    list_exports_api_v1_exports_get: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["ExportKindOut"][];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    health_api_v1_health_get: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["HealthOut"];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    login_api_v1_login_post: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["LoginIn"];
            };
        };
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["MeOut"];
                };
            };
            /** @description The body is not what its type says */
            400: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such name with this password */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The rest of the request did not come */
            408: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No users are configured */
            409: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Larger than a bound of this server */
            413: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Too many attempts: `Retry-After` tells when to try again */
            429: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No room on the disk */
            507: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    leave_api_v1_login_provider_get: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            303: {
                headers: {
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No provider is set */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The provider does not answer */
            502: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    arrive_api_v1_login_provider_answer_get: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            303: {
                headers: {
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description The provider did not sign them in, or this was not begun here */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "text/html": unknown;
                };
            };
            /** @description Nobody that may sign in here */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "text/html": unknown;
                };
            };
            /** @description No provider is set */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Their name is another person's here */
            409: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "text/html": unknown;
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The provider does not answer, or its answer does not hold */
            502: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "text/html": unknown;
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    logout_api_v1_logout_post: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            204: {
                headers: {
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No room on the disk */
            507: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    me_api_v1_me_get: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["MeOut"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    change_password_api_v1_me_password_put: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["PasswordIn"];
            };
        };
        responses: {
            /** @description Successful Response */
            204: {
                headers: {
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description The body is not what its type says */
            400: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such name with this password */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The rest of the request did not come */
            408: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No users are configured */
            409: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Larger than a bound of this server */
            413: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Too many attempts: `Retry-After` tells when to try again */
            429: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No room on the disk */
            507: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    list_methods_api_v1_methods_get: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["MethodOut"][];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    metrics_api_v1_metrics_get: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "text/plain": unknown;
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    list_plans_api_v1_plans_get: {
        parameters: {
            query?: {
                /** @description Of the link to the next page */
                before?: string | null;
                /** @description Rows of the page; 100 where not given */
                limit?: number | null;
                /** @description Words that are all in its name, notes or tags, whatever capitals */
                q?: string | null;
                rig?: string | null;
                /** @description A tag that it has */
                tag?: string | null;
                trajectory?: string | null;
            };
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The next page, `<path>; rel="next"`, where there is one */
                    Link?: string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["PlanOut"][];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    add_plan_api_v1_plans_post: {
        parameters: {
            query?: never;
            header?: {
                /** @description Who commands, while no users are configured: a name for the lease and the audit */
                "x-fullpose-client"?: string | null;
            };
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["PlanIn"];
            };
        };
        responses: {
            /** @description Successful Response */
            202: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["PlanOut"];
                };
            };
            /** @description The body is not what its type says */
            400: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The rest of the request did not come */
            408: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Larger than a bound of this server */
            413: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Too many at once: try again later */
            429: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No room on the disk */
            507: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    get_plan_api_v1_plans__plan__get: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                plan: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["PlanOut"];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    remove_plan_api_v1_plans__plan__delete: {
        parameters: {
            query?: never;
            header?: {
                /** @description Who commands, while no users are configured: a name for the lease and the audit */
                "x-fullpose-client"?: string | null;
            };
            path: {
                plan: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            204: {
                headers: {
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A session has loaded it */
            409: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No room on the disk */
            507: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    label_plan_api_v1_plans__plan__patch: {
        parameters: {
            query?: never;
            header?: {
                /** @description Who commands, while no users are configured: a name for the lease and the audit */
                "x-fullpose-client"?: string | null;
            };
            path: {
                plan: string;
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["LabelsIn"];
            };
        };
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["PlanOut"];
                };
            };
            /** @description The body is not what its type says */
            400: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The rest of the request did not come */
            408: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Larger than a bound of this server */
            413: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No room on the disk */
            507: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    export_plan_api_v1_plans__plan__export_get: {
        parameters: {
            query?: {
                format?: components["schemas"]["ExportKind"];
            };
            header?: never;
            path: {
                plan: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/octet-stream": unknown;
                    "application/vnd.apache.parquet": unknown;
                    "application/x-matlab-data": unknown;
                    "application/x-mdf4": unknown;
                    "application/x-tdms": unknown;
                    "text/csv": unknown;
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The plan is not done */
            409: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    plan_plane_api_v1_plans__plan__plane_get: {
        parameters: {
            query?: {
                columns?: number;
                rows?: number;
            };
            header?: never;
            path: {
                plan: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["PlaneOut"];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The plan is not done, its rig has three axes, or its rig is another by now */
            409: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Too many at once: try again later */
            429: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    add_remedy_api_v1_plans__plan__remedies_post: {
        parameters: {
            query?: never;
            header?: {
                /** @description Who commands, while no users are configured: a name for the lease and the audit */
                "x-fullpose-client"?: string | null;
            };
            path: {
                plan: string;
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["RemedyIn"];
            };
        };
        responses: {
            /** @description Successful Response */
            202: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["PlanOut"];
                };
            };
            /** @description The body is not what its type says */
            400: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The rest of the request did not come */
            408: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Larger than a bound of this server */
            413: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Too many at once: try again later */
            429: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No room on the disk */
            507: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    plan_samples_api_v1_plans__plan__samples_get: {
        parameters: {
            query?: {
                points?: number;
            };
            header?: never;
            path: {
                plan: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["PlanSamples"];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The plan is not done */
            409: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    list_profiles_api_v1_profiles_get: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["ProfileOut"][];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    save_profile_api_v1_profiles__name__put: {
        parameters: {
            query?: never;
            header?: {
                /** @description Who commands, while no users are configured: a name for the lease and the audit */
                "x-fullpose-client"?: string | null;
            };
            path: {
                name: string;
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["ProfileIn"];
            };
        };
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["ProfileOut"];
                };
            };
            /** @description The body is not what its type says */
            400: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The rest of the request did not come */
            408: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A profile that ships has the name */
            409: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Larger than a bound of this server */
            413: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No room on the disk */
            507: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    remove_profile_api_v1_profiles__name__delete: {
        parameters: {
            query?: never;
            header?: {
                /** @description Who commands, while no users are configured: a name for the lease and the audit */
                "x-fullpose-client"?: string | null;
            };
            path: {
                name: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            204: {
                headers: {
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description None of that name */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description It ships with Fullpose */
            409: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No room on the disk */
            507: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    read_file_api_v1_reading_post: {
        parameters: {
            query?: {
                points?: number;
            };
            header?: {
                /** @description Who commands, while no users are configured: a name for the lease and the audit */
                "x-fullpose-client"?: string | null;
            };
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                "multipart/form-data": {
                    /**
                     * @description Fly through gaps by interpolation; they are refused otherwise
                     * @default false
                     */
                    bridge_gaps?: boolean;
                    /** @description A column map as JSON (`ColumnMap`), in the place of a profile */
                    columns?: string;
                    /**
                     * @description The axes it is written in. Default: those of its profile
                     * @enum {string}
                     */
                    convention?: "nue" | "ned" | "enu";
                    /**
                     * @description Of samples with one stamp, keep the first
                     * @default false
                     */
                    drop_duplicates?: boolean;
                    /** Format: binary */
                    file: string;
                    /** @description Which column is what, by the name of a profile. Default: guessed */
                    profile?: string;
                    /** @description Of a file with several attitudes: the topic, message, group or sheet. Default: the only one */
                    source?: string;
                    /**
                     * @description Refuse a flight that there is a warning about
                     * @default false
                     */
                    strict?: boolean;
                };
            };
        };
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["ReadingPreview"];
                };
            };
            /** @description The body is not what its type says */
            400: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The rest of the request did not come */
            408: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Larger than a bound of this server */
            413: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Too many at once: try again later */
            429: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No room on the disk */
            507: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    list_rigs_api_v1_rigs_get: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["RigOut"][];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    get_rig_api_v1_rigs__rig__get: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                rig: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["RigOut"];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    get_alarms_api_v1_rigs__rig__alarms_get: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                rig: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["AlarmOut"][];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    command_api_v1_rigs__rig__commands_post: {
        parameters: {
            query?: never;
            header?: {
                /** @description Who commands, while no users are configured: a name for the lease and the audit */
                "x-fullpose-client"?: string | null;
            };
            path: {
                rig: string;
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["Connect"] | components["schemas"]["Load"] | components["schemas"]["Unload"] | components["schemas"]["Arm"] | components["schemas"]["Disarm"] | components["schemas"]["Start"] | components["schemas"]["Hold"] | components["schemas"]["Resume"] | components["schemas"]["Stop"] | components["schemas"]["Move"] | components["schemas"]["Home"] | components["schemas"]["Jog"] | components["schemas"]["GoLive"] | components["schemas"]["Estop"] | components["schemas"]["Acknowledge"] | components["schemas"]["Shelve"] | components["schemas"]["Unshelve"] | components["schemas"]["Reset"];
            };
        };
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["CommandDone"];
                };
            };
            /** @description A stop was given to a rig process that is not there, or does not answer: `unknown` tells */
            202: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["CommandOut"];
                };
            };
            /** @description The body is not what its type says */
            400: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The rest of the request did not come */
            408: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The session refuses; nothing has changed. Names state, command and what is allowed */
            409: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Larger than a bound of this server */
            413: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The rig process does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No room on the disk */
            507: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    estop_api_v1_rigs__rig__estop_post: {
        parameters: {
            query?: never;
            header?: {
                /** @description Who commands, while no users are configured: a name for the lease and the audit */
                "x-fullpose-client"?: string | null;
            };
            path: {
                rig: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["CommandOut"];
                };
            };
            /** @description A stop was given to a rig process that is not there, or does not answer: `unknown` tells */
            202: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["CommandOut"];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The session refuses; nothing has changed. Names state, command and what is allowed */
            409: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The rig process does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No room on the disk */
            507: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    lease_api_v1_rigs__rig__lease_post: {
        parameters: {
            query?: never;
            header?: {
                /** @description Who commands, while no users are configured: a name for the lease and the audit */
                "x-fullpose-client"?: string | null;
            };
            path: {
                rig: string;
            };
            cookie?: never;
        };
        requestBody?: {
            content: {
                "application/json": components["schemas"]["LeaseIn"] | null;
            };
        };
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["LeaseGiven"];
                };
            };
            /** @description The body is not what its type says */
            400: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The rest of the request did not come */
            408: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The session refuses; nothing has changed. Names state, command and what is allowed */
            409: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Larger than a bound of this server */
            413: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The rig process does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No room on the disk */
            507: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    show_pose_api_v1_rigs__rig__scene_pose_post: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                rig: string;
            };
            cookie?: never;
        };
        requestBody?: {
            content: {
                "application/json": components["schemas"]["ScenePoseIn"] | null;
            };
        };
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["ScenePoseOut"] | null;
                };
            };
            /** @description The body is not what its type says */
            400: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The rest of the request did not come */
            408: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The plan is not done, or is another rig's */
            409: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Larger than a bound of this server */
            413: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No room on the disk */
            507: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    get_session_api_v1_rigs__rig__session_get: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                rig: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["SessionOut"];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    stop_api_v1_rigs__rig__stop_post: {
        parameters: {
            query?: never;
            header?: {
                /** @description Who commands, while no users are configured: a name for the lease and the audit */
                "x-fullpose-client"?: string | null;
            };
            path: {
                rig: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["CommandOut"];
                };
            };
            /** @description A stop was given to a rig process that is not there, or does not answer: `unknown` tells */
            202: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["CommandOut"];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The session refuses; nothing has changed. Names state, command and what is allowed */
            409: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The rig process does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No room on the disk */
            507: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    list_runs_api_v1_runs_get: {
        parameters: {
            query?: {
                /** @description Of the link to the next page */
                before?: string | null;
                /** @description Rows of the page; 100 where not given */
                limit?: number | null;
                /** @description Words that are all in its name, notes or tags, whatever capitals */
                q?: string | null;
                rig?: string | null;
                /** @description A tag that it has */
                tag?: string | null;
            };
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The next page, `<path>; rel="next"`, where there is one */
                    Link?: string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["RunOut"][];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    get_run_api_v1_runs__run__get: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                run: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["RunOut"];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    remove_run_api_v1_runs__run__delete: {
        parameters: {
            query?: never;
            header?: {
                /** @description Who commands, while no users are configured: a name for the lease and the audit */
                "x-fullpose-client"?: string | null;
            };
            path: {
                run: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            204: {
                headers: {
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description It is pinned, or being written */
            409: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No room on the disk */
            507: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    label_run_api_v1_runs__run__patch: {
        parameters: {
            query?: never;
            header?: {
                /** @description Who commands, while no users are configured: a name for the lease and the audit */
                "x-fullpose-client"?: string | null;
            };
            path: {
                run: string;
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["LabelsIn"];
            };
        };
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["RunOut"];
                };
            };
            /** @description The body is not what its type says */
            400: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The rest of the request did not come */
            408: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Larger than a bound of this server */
            413: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No room on the disk */
            507: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    run_curves_api_v1_runs__run__curves_get: {
        parameters: {
            query?: {
                /** @description What to compare with: `run:ID` or `plan:ID` */
                against?: string | null;
            };
            header?: never;
            path: {
                run: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["CurvesOut"];
                };
            };
            /** @description They are being made: ask again */
            202: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["CurvesOut"];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description It is being written, or its curves are being made */
            409: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Too many at once: try again later */
            429: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    curves_window_api_v1_runs__run__curves_window_get: {
        parameters: {
            query: {
                /** @description What to compare with: `run:ID` or `plan:ID` */
                against?: string | null;
                /** @description After the run's first sample */
                from_s: number;
                /** @description After the run's first sample */
                to_s: number;
                /** @description Buckets wanted, one a pixel, say */
                width?: number;
            };
            header?: never;
            path: {
                run: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/octet-stream": unknown;
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description It is being written, or its curves are being made */
            409: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Too many at once: try again later */
            429: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    run_evidence_api_v1_runs__run__evidence_get: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                run: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/zip": unknown;
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description It is being written */
            409: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Too many at once: try again later */
            429: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    export_run_api_v1_runs__run__export_get: {
        parameters: {
            query?: {
                format?: components["schemas"]["ExportKind"];
            };
            header?: never;
            path: {
                run: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/octet-stream": unknown;
                    "application/vnd.apache.parquet": unknown;
                    "application/x-matlab-data": unknown;
                    "application/x-mdf4": unknown;
                    "application/x-tdms": unknown;
                    "text/csv": unknown;
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    pin_run_api_v1_runs__run__pin_put: {
        parameters: {
            query?: never;
            header?: {
                /** @description Who commands, while no users are configured: a name for the lease and the audit */
                "x-fullpose-client"?: string | null;
            };
            path: {
                run: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            204: {
                headers: {
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No room on the disk */
            507: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    unpin_run_api_v1_runs__run__pin_delete: {
        parameters: {
            query?: never;
            header?: {
                /** @description Who commands, while no users are configured: a name for the lease and the audit */
                "x-fullpose-client"?: string | null;
            };
            path: {
                run: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            204: {
                headers: {
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No room on the disk */
            507: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    solve_batch_api_v1_solve_post: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["SolveIn"];
            };
        };
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["SolveOut"];
                };
            };
            /** @description The body is not what its type says */
            400: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The rest of the request did not come */
            408: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Larger than a bound of this server */
            413: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Too many at once: try again later */
            429: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No room on the disk */
            507: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    list_tokens_api_v1_tokens_get: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["TokenOut"][];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No users are configured, or people would be left as they may not be */
            409: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    make_token_api_v1_tokens_post: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["TokenIn"];
            };
        };
        responses: {
            /** @description Successful Response */
            201: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["TokenGiven"];
                };
            };
            /** @description The body is not what its type says */
            400: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The rest of the request did not come */
            408: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No users are configured, or people would be left as they may not be */
            409: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Larger than a bound of this server */
            413: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No room on the disk */
            507: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    revoke_token_api_v1_tokens__token__delete: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                token: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            204: {
                headers: {
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No users are configured, or people would be left as they may not be */
            409: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No room on the disk */
            507: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    list_trajectories_api_v1_trajectories_get: {
        parameters: {
            query?: {
                /** @description Of the link to the next page */
                before?: string | null;
                /** @description Rows of the page; 100 where not given */
                limit?: number | null;
                /** @description Words that are all in its name, notes or tags, whatever capitals */
                q?: string | null;
                /** @description A tag that it has */
                tag?: string | null;
            };
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    /** @description The next page, `<path>; rel="next"`, where there is one */
                    Link?: string;
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["TrajectoryOut"][];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    add_trajectory_api_v1_trajectories_post: {
        parameters: {
            query?: never;
            header?: {
                /** @description Who commands, while no users are configured: a name for the lease and the audit */
                "x-fullpose-client"?: string | null;
            };
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["TrajectoryIn"];
                "multipart/form-data": {
                    /**
                     * @description Fly through gaps by interpolation; they are refused otherwise
                     * @default false
                     */
                    bridge_gaps?: boolean;
                    /** @description A column map as JSON (`ColumnMap`), in the place of a profile */
                    columns?: string;
                    /**
                     * @description The axes it is written in. Default: those of its profile
                     * @enum {string}
                     */
                    convention?: "nue" | "ned" | "enu";
                    /**
                     * @description Of samples with one stamp, keep the first
                     * @default false
                     */
                    drop_duplicates?: boolean;
                    /**
                     * Format: binary
                     * @description A log with one attitude
                     */
                    file: string;
                    /** @description Default: the file's name */
                    name?: string;
                    /** @description Which column is what, by the name of a profile. Default: guessed */
                    profile?: string;
                    /** @description Of a file with several attitudes: the topic, message, group or sheet. Default: the only one */
                    source?: string;
                    /**
                     * @description Refuse a flight that there is a warning about
                     * @default false
                     */
                    strict?: boolean;
                };
            };
        };
        responses: {
            /** @description The very same flight is stored already */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["TrajectoryOut"];
                };
            };
            /** @description Successful Response */
            201: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["TrajectoryOut"];
                };
            };
            /** @description The body is not what its type says */
            400: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The rest of the request did not come */
            408: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Larger than a bound of this server */
            413: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Neither a form nor JSON */
            415: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Too many at once: try again later */
            429: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No room on the disk */
            507: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    get_trajectory_api_v1_trajectories__sha256__get: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                sha256: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["TrajectoryOut"];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    remove_trajectory_api_v1_trajectories__sha256__delete: {
        parameters: {
            query?: never;
            header?: {
                /** @description Who commands, while no users are configured: a name for the lease and the audit */
                "x-fullpose-client"?: string | null;
            };
            path: {
                sha256: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            204: {
                headers: {
                    [name: string]: unknown;
                };
                content?: never;
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A plan is made from it */
            409: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No room on the disk */
            507: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    label_trajectory_api_v1_trajectories__sha256__patch: {
        parameters: {
            query?: never;
            header?: {
                /** @description Who commands, while no users are configured: a name for the lease and the audit */
                "x-fullpose-client"?: string | null;
            };
            path: {
                sha256: string;
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["LabelsIn"];
            };
        };
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["TrajectoryOut"];
                };
            };
            /** @description The body is not what its type says */
            400: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The rest of the request did not come */
            408: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Larger than a bound of this server */
            413: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No room on the disk */
            507: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    diagnose_trajectory_api_v1_trajectories__sha256__diagnosis_get: {
        parameters: {
            query?: {
                rig?: string | null;
            };
            header?: never;
            path: {
                sha256: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["DiagnosisOut"];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Too many at once: try again later */
            429: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    preview_trajectory_api_v1_trajectories__sha256__preview_get: {
        parameters: {
            query?: {
                points?: number;
            };
            header?: never;
            path: {
                sha256: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["TrajectoryPreview"];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    tolerance_of_trajectory_api_v1_trajectories__sha256__tolerance_get: {
        parameters: {
            query?: {
                points?: number;
                tolerance_deg?: number | null;
            };
            header?: never;
            path: {
                sha256: string;
            };
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["ToleranceEffect"];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Too many at once: try again later */
            429: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    list_users_api_v1_users_get: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["UserOut"][];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No users are configured, or people would be left as they may not be */
            409: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    add_user_api_v1_users_post: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["UserIn"];
            };
        };
        responses: {
            /** @description Successful Response */
            201: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["UserOut"];
                };
            };
            /** @description The body is not what its type says */
            400: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The rest of the request did not come */
            408: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No users are configured, or people would be left as they may not be */
            409: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Larger than a bound of this server */
            413: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No room on the disk */
            507: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    change_user_api_v1_users__name__put: {
        parameters: {
            query?: never;
            header?: never;
            path: {
                name: string;
            };
            cookie?: never;
        };
        requestBody: {
            content: {
                "application/json": components["schemas"]["UserChange"];
            };
        };
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["UserOut"];
                };
            };
            /** @description The body is not what its type says */
            400: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No such thing */
            404: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The rest of the request did not come */
            408: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No users are configured, or people would be left as they may not be */
            409: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Larger than a bound of this server */
            413: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Validation Error */
            422: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description No room on the disk */
            507: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
    version_api_v1_version_get: {
        parameters: {
            query?: never;
            header?: never;
            path?: never;
            cookie?: never;
        };
        requestBody?: never;
        responses: {
            /** @description Successful Response */
            200: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/json": components["schemas"]["VersionOut"];
                };
            };
            /** @description Nobody signed in, where people are configured */
            401: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description A foreign page, a foreign name of this server, or a role that is not enough */
            403: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description The database or a process that it takes does not answer */
            503: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
            /** @description Any error, as a problem document */
            default: {
                headers: {
                    [name: string]: unknown;
                };
                content: {
                    "application/problem+json": components["schemas"]["Problem"];
                };
            };
        };
    };
}
export interface sockets {
    "/api/v1/rigs/{rig}/live": { sent: components["schemas"]["LiveMessageIn"]; answered: components["schemas"]["LiveMessageOut"] };
    "/api/v1/rigs/{rig}/stream": { sent: components["schemas"]["StreamMessageIn"]; answered: components["schemas"]["StreamMessageOut"] };
    "/api/v1/runs/{run}/stream": { sent: components["schemas"]["StreamMessageIn"]; answered: components["schemas"]["StreamMessageOut"] };
    "/api/v1/solve": { sent: components["schemas"]["SolveMessageIn"]; answered: components["schemas"]["SolveMessageOut"] };
    "/api/v1/stop": { sent: components["schemas"]["StopMessageIn"]; answered: components["schemas"]["StopMessageOut"] };
}
export interface flags {
    late: 1;
    limited: 2;
    lead: 4;
    enabled: 8;
    braking: 16;
    stale: 32;
}
